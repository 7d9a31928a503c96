//! Knowledge of a node on a real bus: a file below the device that keeps it and the code that collects it.

use std::collections::BTreeMap;
use std::prelude::v1::*;

use od_model::Address;
use od_model::typed::MapEntry;
use od_wire::CanId;
use od_wire::nmt::State;

use crate::words::fold::Folder;

/// Knowledge of a node.
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
    /// TPDOs by the values that were seen; `None`: to be looked up.
    pub(crate) tpdos: Option<Vec<Tpdo>>,
}

/// A TPDO of the node.
#[derive(Clone)]
pub(crate) struct Tpdo {
    pub(crate) id: CanId,
    pub(crate) entries: Vec<MapEntry>,
}
