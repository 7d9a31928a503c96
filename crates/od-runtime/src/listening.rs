//! The table of the CAN-IDs that the node listens to: which service a frame belongs to, and what the acceptance
//! filters of a CAN controller let through.

use od_wire::{CanId, Frame};

use crate::blank::Blank;

/// Service that a frame belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Service {
    Nmt,
    Lss,
    /// A remote frame of a master that guards this node.
    Guarding,
    /// Heartbeat of a node that is watched.
    Heartbeat,
    /// Request for the SDO server at this position.
    Sdo(u8),
    Time,
    Sync,
    /// Frame of the RPDO with this number, and maybe of others with the same CAN-ID.
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
    /// The CAN-ID.
    pub(crate) fn id(&self) -> CanId {
        if self.key & EXTENDED != 0 {
            CanId::extended(self.key & !(EXTENDED | REMOTE))
        } else {
            CanId::standard(self.key as u16)
        }
    }
}

/// A table that is being filled: sorted by CAN-ID, and among equal ones in the order of their arrival.
pub(crate) struct Table<'t> {
    pub(crate) places: &'t mut [Listener],
    pub(crate) len: usize,
}

impl Table<'_> {
    /// Adds a service, if it has a CAN-ID.
    pub(crate) fn add(&mut self, id: Option<CanId>, is_remote: bool, service: Service) {
        let Some(id) = id else { return };
        let key = key(id, is_remote);
        // There is a place for each service of the device.
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

/// The service that a frame belongs to; `None`: it is for other nodes.
pub(crate) fn find(table: &[Listener], frame: &Frame) -> Option<Service> {
    let wanted = key(frame.id(), frame.is_remote());
    let at = table.partition_point(|listener| listener.key < wanted);
    let listener = table.get(at)?;
    (listener.key == wanted).then_some(listener.service)
}
