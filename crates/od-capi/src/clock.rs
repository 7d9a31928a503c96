//! Time of the host: a counter of microseconds that wraps after 71 minutes.

use odkit::Instant;

/// Longest sleep, in microseconds: a quarter of the time in which the counter wraps.
pub(crate) const LONGEST_SLEEP: u32 = 1 << 30;

/// Extends the counter of the host.
#[derive(Debug)]
pub(crate) struct Clock {
    /// Microseconds since the first power-on.
    micros: u64,
    /// The counter at that time.
    counter: u32,
}

impl Clock {
    pub(crate) const fn new() -> Self {
        Self {
            micros: 0,
            counter: 0,
        }
    }

    /// Power-on: the counter has this value, and time continues from the last time.
    pub(crate) fn start(&mut self, counter: u32) -> Instant {
        self.counter = counter;
        Instant::from_micros(self.micros)
    }

    /// Returns the time of a counter value. A value that runs back leaves the time unchanged.
    pub(crate) fn at(&mut self, counter: u32) -> Instant {
        let step = counter.wrapping_sub(self.counter);
        if step <= i32::MAX as u32 {
            self.micros += u64::from(step);
            self.counter = counter;
        }
        Instant::from_micros(self.micros)
    }

    /// Time of the last call.
    pub(crate) const fn last(&self) -> Instant {
        Instant::from_micros(self.micros)
    }
}

/// Microseconds until `at`, at most [`LONGEST_SLEEP`].
pub(crate) fn until(now: Instant, at: Option<Instant>) -> u32 {
    let longest = u64::from(LONGEST_SLEEP);
    let wait = at.map_or(longest, |at| at.micros_since(now).min(longest));
    wait as u32
}
