//! The table of the CAN-IDs that the node listens to. It gives the service of a frame, and the
//! acceptance filters of a CAN controller are made of it.

use od_wire::{CanId, Frame};

use crate::blank::Blank;

/// Service that a frame belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Service {
    Nmt,
    Lss,
    /// A remote frame of a master that guards this node.
    Guarding,
    /// Heartbeat of a monitored node.
    Heartbeat,
    /// Request for the SDO server at this position.
    Sdo(u8),
    Time,
    Sync,
    /// Frame of the RPDO with this number, and possibly of further RPDOs with the same CAN-ID.
    Rpdo(u16),
    /// Remote frame that requests the TPDO with this number.
    TpdoRequest(u16),
}

/// A CAN-ID with the service that listens to it.
#[derive(Clone, Copy, Debug)]
pub struct Listener {
    /// CAN-ID and kind of frame as one number: the order of the table.
    key: u32,
    service: Service,
}

impl Blank for Listener {
    const BLANK: Self = Self {
        key: 0,
        service: Service::Nmt,
    };
}

const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;

fn key(id: CanId, is_remote: bool) -> u32 {
    let extended = if id.is_extended() { EXTENDED } else { 0 };
    id.raw() | extended | if is_remote { REMOTE } else { 0 }
}

impl Listener {
    pub(crate) fn id(&self) -> CanId {
        if self.key & EXTENDED != 0 {
            CanId::extended(self.key & !(EXTENDED | REMOTE))
        } else {
            CanId::standard(self.key as u16)
        }
    }
}

/// A table while it is filled: sorted by CAN-ID; entries with the same CAN-ID keep the order in
/// which they were added.
pub(crate) struct Table<'t> {
    pub(crate) places: &'t mut [Listener],
    pub(crate) len: usize,
}

impl Table<'_> {
    pub(crate) fn add(&mut self, id: Option<CanId>, is_remote: bool, service: Service) {
        let Some(id) = id else { return };
        let key = key(id, is_remote);
        // The table has a place for each service of the device.
        let Some(end) = self.places.get_mut(self.len) else {
            return;
        };
        *end = Listener { key, service };
        for at in (1..=self.len).rev() {
            match self.places.get_mut(at - 1..=at) {
                Some([before, place]) if before.key > place.key => core::mem::swap(before, place),
                _ => break,
            }
        }
        self.len += 1;
    }
}

/// Returns the service of a frame; `None`: the frame is for other nodes.
pub(crate) fn find(table: &[Listener], frame: &Frame) -> Option<Service> {
    let wanted = key(frame.id(), frame.is_remote());
    let at = table.partition_point(|listener| listener.key < wanted);
    let listener = table.get(at)?;
    (listener.key == wanted).then_some(listener.service)
}
