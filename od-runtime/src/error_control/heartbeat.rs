//! Heartbeat producer (CiA 301, chapter 7.2.8.2.2, object 1017h).

use crate::deadline::Deadline;
use crate::device::Device;
use crate::profile::Profile;
use crate::store::Store;
use od_wire::Instant;

/// Time when the next heartbeat is due.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Producer {
    period_ms: u32,
    next: Deadline,
}

impl Producer {
    pub(crate) const fn new() -> Self {
        Self {
            period_ms: 0,
            next: Deadline::NEVER,
        }
    }

    /// 1017h was written, or the device boots: the first heartbeat is one period from now.
    #[inline(never)]
    pub(crate) fn configure<D: Device>(
        &mut self,
        store: &Store<'_>,
        profile: &Profile,
        now: Instant,
    ) {
        let guards = super::guards::<D>(store, profile);
        self.period_ms = match guards {
            true => 0,
            false => store.word(0x1017, 0, 0),
        };
        self.next = match self.period_ms {
            0 => Deadline::NEVER,
            period => Deadline::at(now.plus_millis(period.into())),
        };
    }

    /// No heartbeat until [`configure`](Self::configure).
    pub(crate) fn stop(&mut self) {
        self.next = Deadline::NEVER;
    }

    /// Returns whether a heartbeat is due, and plans the next one.
    #[inline]
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> bool {
        let is_due = self.next.is_due(now);
        if is_due {
            self.next = self.next.next_period(self.period_ms, now);
        }
        is_due
    }

    /// Time when the next one is due.
    #[inline]
    pub(crate) fn deadline(&self) -> Deadline {
        self.next
    }
}
