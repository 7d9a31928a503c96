//! CAN-IDs that the node listens to, for the acceptance filters of a CAN controller.

use od_wire::CanId;

use super::{Machines, Node};
use crate::device::Device;
use crate::extras::Extras;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Returns the CAN-IDs of all frames, data and remote, that mean anything to the node in any NMT
    /// state. Some may come twice.
    pub fn wanted_ids(&self) -> impl Iterator<Item = CanId> + '_ {
        self.machines.wanted_ids()
    }

    /// Returns [`wanted_ids`](Self::wanted_ids) if they may have changed since the last call: at
    /// power-on, after a reset, a new node ID, or a change of a COB-ID or of 1016h.
    pub fn poll_wanted_ids(&mut self) -> Option<impl Iterator<Item = CanId> + '_> {
        let changed = core::mem::take(&mut self.machines.wanted_changed);
        changed.then(|| self.machines.wanted_ids())
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    fn wanted_ids(&self) -> impl Iterator<Item = CanId> + '_ {
        let has_lss = D::LSS && D::PROFILE.is_none_or(|profile| profile.lss.is_some());
        let lss = has_lss.then_some(CanId::standard(od_wire::lss::MASTER));
        let has_id = !self.unconfigured;
        let own = [
            Some(CanId::standard(0)),
            Some(self.node_id.plus(0x600)),
            D::GUARDING.then(|| self.node_id.plus(0x700)),
            self.sync_id,
        ];
        let tpdos = self.tpdos().iter();
        let rpdos = self.rpdos().iter();
        let others = own
            .into_iter()
            .flatten()
            .chain(tpdos.filter_map(|pdo| pdo.requested_by()))
            .chain(
                rpdos
                    .filter_map(|pdo| pdo.received_by())
                    .filter(|_| D::RPDOS),
            )
            .chain(self.time_id().filter(|_| D::TIME))
            .chain(
                self.extras
                    .servers()
                    .iter()
                    .filter_map(|one| one.received_by())
                    .filter(|_| D::SERVERS),
            )
            .chain(self.monitor.watched().filter(|_| D::CONSUMER));
        lss.into_iter().chain(others.filter(move |_| has_id))
    }
}
