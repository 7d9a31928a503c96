//! The table of CAN-IDs: each service adds those that it listens to.

use od_wire::{CanId, Frame};

use super::{Machines, Node};
use crate::device::Device;
use crate::listening::{self, Listener, Service, Table};
use crate::objects::Objects;
use crate::rooms::{Rooms, Slices};

impl<D: Device> Machines<D> {
    /// Fills the table again, after a change of objects or of the node ID.
    pub(super) fn listen(&mut self, objects: &Objects<'_, D>) {
        self.wanted_changed = true;
        let node_id = self.node_id;
        let Slices {
            listeners,
            servers,
            tpdos,
            rpdos,
            watches,
            clocks,
            ..
        } = self.rooms.all_mut();
        let mut table = Table {
            places: listeners,
            len: 0,
        };
        if D::LSS && objects.profile.lss.is_some() {
            let master = CanId::standard(od_wire::lss::MASTER);
            table.add(Some(master), false, Service::Lss);
        }
        // A node without a node ID listens to LSS only (CiA 305, chapter 6.4.2).
        if !self.unconfigured {
            table.add(Some(CanId::standard(0)), false, Service::Nmt);
            if D::GUARDING {
                table.add(Some(node_id.plus(0x700)), true, Service::Guarding);
            }
            for watch in &*watches {
                table.add(watch.received_by(), false, Service::Heartbeat);
            }
            for (at, server) in (0..).zip(&*servers) {
                table.add(server.received_by(), false, Service::Sdo(at));
            }
            for clocks in &*clocks {
                table.add(clocks.time_id, false, Service::Time);
            }
            table.add(self.sync_id, false, Service::Sync);
            for (number, pdo) in (0..).zip(&*rpdos) {
                table.add(pdo.received_by(), false, Service::Rpdo(number));
            }
            for (number, pdo) in (0..).zip(&*tpdos) {
                table.add(pdo.requested_by(), true, Service::TpdoRequest(number));
            }
        }
        self.listeners = table.len as u16;
    }

    fn listening(&self) -> &[Listener] {
        let listeners = self.rooms.all().listeners.get(..self.listeners.into());
        listeners.unwrap_or_default()
    }

    /// Returns the service of a frame; `None`: the frame is for other nodes.
    pub(super) fn service(&self, frame: &Frame) -> Option<Service> {
        listening::find(self.listening(), frame)
    }
}

impl<D: Device, A, S> Node<D, A, S> {
    /// Returns the CAN-IDs of all data and remote frames that the node uses in any NMT state. Some
    /// may be returned twice.
    pub fn wanted_ids(&self) -> impl Iterator<Item = CanId> + '_ {
        self.machines.listening().iter().map(Listener::id)
    }

    /// Returns [`wanted_ids`](Self::wanted_ids) if they may have changed since the last call: at
    /// power-on, after a reset, after a new node ID, and after a change of a COB-ID or of 1016h.
    pub fn poll_wanted_ids(&mut self) -> Option<impl Iterator<Item = CanId> + '_> {
        let changed = core::mem::take(&mut self.machines.wanted_changed);
        changed.then(|| self.wanted_ids())
    }
}
