//! Relates the time of the bus to the time of the computer.

use std::time::{Duration, Instant as Clock, SystemTime};

use od_runtime::Instant;

/// A bus that is later than this continues from now and does not catch up.
pub(super) const LATE: Duration = Duration::from_millis(50);
/// A delay within this time after an earlier one is not reported again: the user already knows that the
/// computer is too slow.
const AGAIN: Duration = Duration::from_secs(1);
/// A delay of this length is always reported: no slow computer causes it.
const LONG: Duration = Duration::from_millis(500);

/// The time of the bus: that of the computer, without the times when the process did not run.
pub(super) struct Pace {
    start: Clock,
    /// Time of day at the start of the bus, in microseconds.
    epoch: u64,
    /// Time of the last delay.
    last: Option<Clock>,
}

impl Pace {
    /// Starts the time now.
    pub(super) fn new() -> Self {
        let epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        Self {
            start: Clock::now(),
            epoch: epoch.map_or(0, |since| since.as_micros() as u64),
            last: None,
        }
    }

    /// The time of the bus at `clock`.
    pub(super) fn at(&self, clock: Clock) -> Instant {
        Instant::ZERO + clock.saturating_duration_since(self.start)
    }

    /// The time of day at a moment of the bus, in microseconds.
    pub(super) fn stamp(&self, at: Instant) -> u64 {
        self.epoch + at.as_micros()
    }

    /// Shifts the time of the bus so that it is `due` at `clock`, if it would be late otherwise. Returns
    /// the delay if it has to be reported.
    pub(super) fn shift(&mut self, due: Instant, clock: Clock) -> Option<Duration> {
        let late = self.at(clock) - due;
        if late <= LATE {
            return None;
        }
        self.start += late;
        self.epoch += late.as_micros() as u64;
        let before = self.last.replace(clock);
        let known = before.is_some_and(|last| clock.duration_since(last) < AGAIN);
        (!known || late >= LONG).then_some(late)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_bus_does_not_catch_up() {
        let mut pace = Pace::new();
        let after = |millis| pace_start() + Duration::from_millis(millis);
        fn pace_start() -> Clock {
            static START: std::sync::OnceLock<Clock> = std::sync::OnceLock::new();
            *START.get_or_init(Clock::now)
        }
        pace.start = pace_start();
        let millis = |millis: u64| Instant::from_micros(millis * 1000);
        let day = pace.stamp(millis(100));
        assert_eq!(pace.at(after(100)), millis(100));
        // A bus counts as late only after 50 ms, and never while nothing is due.
        assert_eq!(pace.shift(millis(100), after(150)), None);
        assert_eq!(pace.shift(millis(900), after(700)), None);
        assert_eq!(pace.at(after(150)), millis(150));
        // A delay of 5 s is reported once.
        let late = Some(Duration::from_secs(5));
        assert_eq!(pace.shift(millis(100), after(5100)), late);
        assert_eq!(pace.at(after(5100)), millis(100));
        assert_eq!(pace.stamp(millis(100)), day + 5_000_000);
        assert_eq!(pace.shift(millis(100), after(5200)), None);
        assert_eq!(pace.at(after(5200)), millis(100));
        let late = Some(Duration::from_millis(500));
        assert_eq!(pace.shift(millis(100), after(5700)), late);
        let late = Some(Duration::from_millis(1000));
        assert_eq!(pace.shift(millis(100), after(6700)), late);
    }
}
