//! What the node does when the other side is lost (CiA 301, object 1029h).

use super::Core;
use crate::Error;
use crate::objects::Objects;
use crate::wire::nmt::State;

/// EMCY code of a life guarding or heartbeat error (CiA 301, table 26).
const LOST: u16 = 0x8130;

impl<const PDO: usize, const SDO: usize> Core<PDO, SDO> {
    /// Takes over what the monitor has to say.
    #[inline]
    pub(super) fn poll_monitor(&mut self, objects: &mut Objects<'_>) {
        if let Some(lost) = self.monitor.poll() {
            self.tell(objects, lost);
        }
    }

    /// Somebody was lost, or everybody is back.
    #[cold]
    fn tell(&mut self, objects: &mut Objects<'_>, lost: bool) {
        let info = objects.application.error_info(&objects.store);
        if lost {
            objects.outbox.signals.raise(Error {
                code: LOST,
                register: 0x11,
                info,
            });
            self.react(objects);
        } else {
            objects.outbox.signals.clear(LOST, info);
        }
    }

    /// Communication error: what 1029h:01 asks for. Without that object it is
    /// Pre-operational, from Operational (chapter 7.5.2.32).
    pub(super) fn react(&mut self, objects: &mut Objects<'_>) {
        match objects.store.try_unsigned(0x1029, 1) {
            None | Some(0) if self.state == State::Operational => {
                self.enter(objects, State::PreOperational);
            }
            Some(2) => self.enter(objects, State::Stopped),
            // Of the families that take the value, the bus covers alone have it.
            Some(3) => self.reset_due = true,
            _ => {}
        }
    }
}
