//! What a node knows of its device at compile time.

use od_model::Dictionary;

/// A device as a type: what the compiler is to know of it.
///
/// `object_dictionary!` implements it for the type `Device` of each module that it makes.
/// `Node<Device, PDO, SDO>` does not compile unless it fits the dictionary.
pub trait Device {
    /// The dictionary that the node serves; `None`: not known before run time, so that
    /// [`Node::power_on`](crate::Node::power_on) checks it.
    const DICTIONARY: Option<Dictionary<'static>> = None;
}

/// A device whose dictionary is not known before run time.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct AnyDevice;

impl Device for AnyDevice {}
