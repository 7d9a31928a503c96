//! Heartbeat producer (CiA 301, chapter 7.2.8.2.2, object 1017h).

use crate::profile::Profile;
use crate::store::Store;
use od_wire::Instant;

/// When the next heartbeat is due.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Producer {
    period_us: u64,
    next: Option<Instant>,
}

impl Producer {
    pub(crate) const fn new() -> Self {
        Self {
            period_us: 0,
            next: None,
        }
    }

    /// 1017h was written, or the device boots: the first heartbeat is one period from now.
    pub(crate) fn configure(&mut self, store: &Store<'_>, profile: &Profile, now: Instant) {
        let guards = super::guards(store, profile);
        self.period_us = if guards {
            0
        } else {
            store.unsigned(0x1017, 0) * 1000
        };
        self.next = (self.period_us > 0).then(|| now.plus_micros(self.period_us));
    }

    /// No heartbeat until [`configure`](Self::configure).
    pub(crate) fn stop(&mut self) {
        self.next = None;
    }

    /// Returns whether a heartbeat is due, and plans the next one.
    #[inline]
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> bool {
        match self.next {
            Some(at) if at <= now => {
                self.next = Some(at.next_period(self.period_us, now));
                true
            }
            _ => false,
        }
    }

    /// When the next one is due.
    #[inline]
    pub(crate) fn deadline(&self) -> Option<Instant> {
        self.next
    }
}
