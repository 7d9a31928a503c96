//! The node that a device is on the bus: simulated, recorded, or a node of a real bus.
//!
//! All three are one type, because scripts, pages and masters treat them alike: only the calls of the bus differ.

#[cfg(feature = "real")]
use std::collections::BTreeMap;

#[cfg(feature = "real")]
use od_model::Address;
#[cfg(feature = "real")]
use od_model::typed::MapEntry;
#[cfg(feature = "real")]
use od_wire::CanId;
#[cfg(feature = "real")]
use od_wire::nmt::State;

#[cfg(feature = "serve")]
use crate::recorded::play::Playing;
#[cfg(feature = "real")]
use crate::words::fold::Folder;

/// The node that a device is on the bus.
#[derive(Clone, Default)]
pub(crate) enum Role {
    /// Its node.
    #[default]
    Node,
    /// Its node, with the response times, values and errors of a recording.
    #[cfg(feature = "serve")]
    Recorded(Box<Playing>),
    /// A node of a real bus. The device sends nothing, and learns values and state from the frames of the node.
    #[cfg(feature = "real")]
    Described(Box<Described>),
}

/// Knowledge of a node on a real bus.
#[cfg(feature = "real")]
#[derive(Clone, Default)]
pub(crate) struct Described {
    pub(crate) state: Option<State>,
    /// Values that were seen since the node started.
    pub(crate) known: BTreeMap<Address, Vec<u8>>,
    pub(crate) folder: Folder,
    /// SDO frames so far.
    pub(crate) count: u32,
    /// The value of a download that is not confirmed.
    pub(crate) written: Option<(Address, Vec<u8>)>,
    /// TPDOs according to the values that were seen; `None`: they have to be looked up.
    pub(crate) tpdos: Option<Vec<Tpdo>>,
}

/// A TPDO of the node.
#[cfg(feature = "real")]
#[derive(Clone)]
pub(crate) struct Tpdo {
    pub(crate) id: CanId,
    pub(crate) entries: Vec<MapEntry>,
}
