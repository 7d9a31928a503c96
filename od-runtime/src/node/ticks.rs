//! Ticks of event timers, where nothing else is due.

use od_wire::Instant;
use od_wire::nmt::State;

use super::{Machines, pending};
use crate::device::{Device, ROOMY};
use crate::extras::Extras;
use crate::pdo;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Finds out whether event timers do no more than have their TPDOs sent.
    pub(super) fn expect_ticks(&mut self) {
        let mut ticks = 0;
        let is_all = self.state == State::Operational
            && self.mute.is_none()
            && !self.watches_changes
            && !self.watches_live;
        if is_all && self.tpdos().iter().all(pdo::Tpdo::only_ticks::<D>) {
            ticks = self.timed();
        }
        for tick in &mut self.quick.ticks {
            tick.timed = ticks;
        }
    }

    /// The TPDOs whose event timers run, in the bits of those that are marked; 0 if others have one, too.
    fn timed(&self) -> u8 {
        let (mut timed, mut mark) = (0, pending::FIRST_MARK);
        for pdo in self.tpdos() {
            if pdo.deadline::<D>().is_set() {
                if mark == 0 {
                    return 0;
                }
                timed |= mark;
            }
            mark <<= 1;
        }
        timed
    }

    /// Finds out when something is due next, except frames that wait.
    #[inline(always)]
    pub(super) fn find_next(&mut self) {
        self.next = self.timers().moment();
        if ROOMY {
            let others = self.timers_but_pdos();
            for tick in &mut self.quick.ticks {
                tick.others = others;
            }
        }
    }

    /// Has event timers send their TPDOs, if that is all that is due; returns whether it is. A host that
    /// plays a device does nothing else all day; a firmware would pay in flash for it.
    #[inline(always)]
    pub(super) fn tick_pdos(&mut self) -> bool {
        let now = self.now;
        let Some(tick) = self.quick.ticks.first().filter(|tick| tick.timed != 0) else {
            return false;
        };
        let (mut first, mut rest) = (tick.others, tick.timed);
        if self.next == Instant::ZERO || first.is_due(now) {
            return false;
        }
        while rest != 0 {
            let others = rest & (rest - 1);
            let (mark, at) = (rest ^ others, pending::position(rest));
            rest = others;
            let Some(pdo) = self.tpdo.get_mut(at) else {
                continue;
            };
            if pdo.is_due(now) {
                // What nothing holds back is sent without a look at the others.
                self.pending |= match pdo.tick(now) {
                    true => pending::PDO,
                    false => mark,
                };
            }
            first = first.or(pdo.deadline::<D>());
        }
        self.next = first.moment();
        true
    }
}
