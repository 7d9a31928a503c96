//! The clock of a device of a file: TIME messages set it, and it produces TIME messages.

use od_model::Address;
use od_runtime::{Context, Instant, TimeOfDay};

/// Time from one TIME message to the next, in microseconds.
const PERIOD_US: u64 = 1_000_000;

/// Bit 30 of 1012h: the device produces TIME.
const PRODUCER: u64 = 1 << 30;

/// A clock that begins at January 1, 1984, when the power is switched on.
#[derive(Clone, Default)]
pub(crate) struct Clock {
    set_to: TimeOfDay,
    set_at: Instant,
    /// The next TIME message.
    next: Option<Instant>,
}

impl Clock {
    /// Sets the time that it shows at `now`.
    pub(crate) fn set(&mut self, now: Instant, time: TimeOfDay) {
        (self.set_to, self.set_at) = (time, now);
    }

    /// Returns the time that it shows at `now`.
    pub(crate) fn time(&self, now: Instant) -> TimeOfDay {
        let millis = now.micros_since(self.set_at) / 1000;
        self.set_to.plus_millis(millis)
    }

    /// Returns whether this object switches its messages on or off.
    pub(crate) fn is_configuration(address: Address) -> bool {
        address == Address::new(0x1012, 0)
    }

    /// Requests a message if it is due. Returns the time of the next one.
    pub(crate) fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        if cx.store.try_unsigned(0x1012, 0).unwrap_or(0) & PRODUCER == 0 {
            self.next = None;
            return None;
        }
        let next = self.next.unwrap_or(cx.now.plus_micros(PERIOD_US));
        let is_due = next <= cx.now;
        if is_due {
            cx.signals.send_time();
        }
        self.next = Some(if is_due {
            next.next_period(PERIOD_US, cx.now)
        } else {
            next
        });
        self.next
    }
}
