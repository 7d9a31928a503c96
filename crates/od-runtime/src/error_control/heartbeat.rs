//! Heartbeat producer (CiA 301, chapter 7.2.8.3.2.2, object 1017h).

use crate::deadline::Deadline;
use crate::profile::Profile;
use crate::services::Services;
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

    /// Reads 1017h, after a download or at boot-up: the first heartbeat is due after one period.
    pub(crate) fn configure<D: Services>(
        &mut self,
        store: &Store<'_>,
        profile: &Profile,
        now: Instant,
    ) {
        self.period_ms = if super::guards::<D>(store, profile) {
            0
        } else {
            store.word(0x1017, 0, 0)
        };
        self.next = match self.period_ms {
            0 => Deadline::NEVER,
            period => Deadline::at(now.plus_millis(period.into())),
        };
    }

    /// Sends no heartbeat until [`configure`](Self::configure).
    pub(crate) fn stop(&mut self) {
        self.next = Deadline::NEVER;
    }

    /// Returns whether a heartbeat is due, and plans the next one.
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> bool {
        let is_due = self.next.is_due(now);
        if is_due {
            self.next = self.next.next_period(self.period_ms, now);
        }
        is_due
    }

    /// Time when the next heartbeat is due.
    pub(crate) fn deadline(&self) -> Deadline {
        self.next
    }
}
