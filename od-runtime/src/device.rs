//! Properties of a device that are known at compile time.

use od_model::Dictionary;

/// Device as a type, so that the compiler can check a node against its dictionary.
///
/// `object_dictionary!` implements it for the type `Device` of each module that it makes.
/// `Node<Device, PDO, SDO>` does not compile unless it fits the dictionary.
pub trait Device {
    /// Dictionary that the node serves; `None`: known at run time, when
    /// [`Node::power_on`](crate::Node::power_on) checks it.
    const DICTIONARY: Option<Dictionary<'static>> = None;
}

/// Device whose dictionary is known at run time only.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct AnyDevice;

impl Device for AnyDevice {}
