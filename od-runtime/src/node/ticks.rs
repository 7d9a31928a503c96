//! Ticks of event timers, where nothing else is due.

use od_wire::nmt::State;

use super::Machines;
use crate::device::Device;
use crate::extras::Extras;
use crate::pdo;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Has event timers send their TPDOs, if that is all that is due; returns whether it is. A host that
    /// plays any device does nothing else all day; the firmware of one device would pay in flash for it.
    #[inline(never)]
    pub(super) fn tick_pdos(&mut self) -> bool {
        let now = self.now;
        let mut first = self.timers_but_pdos();
        let is_all = self.state == State::Operational
            && self.mute.is_none()
            && !self.watches_changes
            && !self.watches_live
            && !first.is_due(now)
            && self.tpdos().iter().all(pdo::Tpdo::only_ticks::<D>);
        if is_all {
            let mut pending = false;
            for pdo in self.tpdos_mut() {
                first = first.or(pdo.tick::<D>(now));
                pending |= pdo.is_pending();
            }
            self.pend_pdo(pending);
            self.next = first.moment();
        }
        is_all
    }
}
