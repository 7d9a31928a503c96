//! Knowledge of a node of a real bus that a device describes.

use std::collections::BTreeMap;
use std::prelude::v1::*;

use od_model::Address;
use od_model::typed::MapEntry;
use od_wire::CanId;
use od_wire::nmt::State;

use crate::words::fold::Folder;

/// Knowledge of a node.
#[derive(Clone, Default)]
pub(super) struct Described {
    pub(super) state: Option<State>,
    /// Values that were seen since the node started.
    pub(super) known: BTreeMap<Address, Vec<u8>>,
    pub(super) folder: Folder,
    /// SDO frames so far.
    pub(super) count: u32,
    /// The value of a download that is not confirmed.
    pub(super) written: Option<(Address, Vec<u8>)>,
    /// TPDOs by the values that were seen; `None`: to be looked up.
    pub(super) tpdos: Option<Vec<Tpdo>>,
}

/// A TPDO of the node.
#[derive(Clone)]
pub(super) struct Tpdo {
    pub(super) id: CanId,
    pub(super) entries: Vec<MapEntry>,
}
