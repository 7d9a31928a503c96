//! Time stamps of an adapter or a server, on the clock of the link.

use od_wire::Instant;

/// A difference to the time of arrival, in microseconds, that no transport causes: the other clock was set.
const STEP: i64 = 5_000_000;
/// Time in microseconds for which the smallest difference counts at least, and half of the time for which it counts at
/// most. In this time a clock that is wrong by 100 ppm gains or loses 1 ms at most.
const WINDOW: i64 = 5_000_000;

/// Time at which an adapter or a server received a frame, by its own clock.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Stamp {
    /// Microseconds.
    pub(super) micros: u64,
    /// Number of microseconds after which the clock begins again at 0; 0: it does not.
    pub(super) period: u64,
}

/// Translates the stamps of one clock.
///
/// A frame can only arrive late: the smallest difference between arrival and stamp is that of the two clocks. Only the last
/// seconds count, since no two clocks have the same rate, and the clock of a simulator that did not run is behind.
#[derive(Default)]
pub(super) struct Stamps {
    known: Option<Known>,
}

/// Differences of the clocks, in microseconds.
#[derive(Clone, Copy)]
struct Known {
    /// Arrival of the first frame of this window.
    since: i64,
    /// The smallest difference in this window.
    smallest: i64,
    /// The smallest difference in the window before.
    before: i64,
}

impl Known {
    fn new(arrival: i64, difference: i64) -> Self {
        Self {
            since: arrival,
            smallest: difference,
            before: difference,
        }
    }

    fn offset(&self) -> i64 {
        self.smallest.min(self.before)
    }

    /// With the difference of a frame that arrived now.
    fn with(self, arrival: i64, difference: i64) -> Self {
        let age = arrival - self.since;
        if difference - self.offset() > STEP || age > 2 * WINDOW {
            Self::new(arrival, difference)
        } else if age > WINDOW {
            Self {
                before: self.smallest,
                ..Self::new(arrival, difference)
            }
        } else {
            Self {
                smallest: self.smallest.min(difference),
                ..self
            }
        }
    }
}

impl Stamps {
    /// Time of the frame on the bus, by the clock of the link. It arrived at `now`.
    pub(super) fn place(&mut self, now: Instant, stamp: Stamp) -> Instant {
        let arrival = signed(now.as_micros());
        let (micros, period) = (signed(stamp.micros), signed(stamp.period));
        let Some(known) = self.known else {
            self.known = Some(Known::new(arrival, arrival - micros));
            return now;
        };
        // The difference does not include the turns: each stamp gets its own.
        let turns = match period {
            0 => 0,
            period => (arrival - known.offset() - micros + period / 2).div_euclid(period),
        };
        let micros = micros + turns * period;
        let known = known.with(arrival, arrival - micros);
        self.known = Some(known);
        Instant::from_micros(u64::try_from(micros + known.offset()).unwrap_or(0))
    }
}

fn signed(micros: u64) -> i64 {
    i64::try_from(micros).unwrap_or(i64::MAX / 4)
}

#[cfg(test)]
mod tests {
    use super::{Stamp, Stamps};
    use od_wire::Instant;

    /// Places stamps in milliseconds that arrive at these milliseconds.
    fn placed(period: u64, frames: &[(u64, u64)]) -> Vec<u64> {
        let mut stamps = Stamps::default();
        let place = |(stamp, now): &(u64, u64)| {
            let stamp = Stamp {
                micros: stamp * 1000,
                period: period * 1000,
            };
            let at = stamps.place(Instant::from_micros(now * 1000), stamp);
            at.as_micros() / 1000
        };
        frames.iter().map(place).collect()
    }

    #[test]
    fn a_late_arrival_does_not_move_a_frame() {
        let frames = [(5000, 10), (5100, 110), (5200, 290), (5300, 310)];
        assert_eq!(placed(0, &frames), [10, 110, 210, 310]);
        // The first one was late itself.
        let frames = [(5000, 90), (5100, 110), (5200, 290), (5300, 310)];
        assert_eq!(placed(0, &frames), [90, 110, 210, 310]);
    }

    #[test]
    fn the_clock_of_an_adapter_begins_again() {
        let frames = [
            (59_900, 10),
            (0, 110),
            (100, 210),
            (59_950, 60_060),
            (50, 60_160),
        ];
        assert_eq!(placed(60_000, &frames), [10, 110, 210, 60_060, 60_160]);
    }

    #[test]
    fn a_clock_that_is_set_is_followed() {
        let frames = [
            (50_000, 10),
            (40_000, 110),
            (40_100, 210),
            (90_000, 310),
            (90_100, 410),
        ];
        assert_eq!(placed(0, &frames), [10, 110, 210, 310, 410]);
    }

    #[test]
    fn a_clock_may_be_slower() {
        // 100 ppm slower for an hour, with a frame every 100 ms or every 2 ms.
        for pause in [100, 2] {
            let frames = (0..3_600_000 / pause).map(|n| n * pause);
            let frames: Vec<_> = frames.map(|now| (now - now / 10_000, now)).collect();
            let at = placed(0, &frames);
            assert!(at.iter().zip(&frames).all(|(at, (_, now))| now - at <= 2));
        }
    }

    /// A simulator that the computer did not run for 60 ms continues with the time before.
    #[test]
    fn a_clock_may_stop_for_a_while() {
        let frames: Vec<_> = (0..600)
            .map(|n| (n * 50 - u64::from(n >= 100) * 60, n * 50))
            .collect();
        let at = placed(0, &frames);
        assert_eq!(at[99], 4950);
        assert_eq!(at[100], 4940);
        assert_eq!(at[350], 17_500);
    }

    #[test]
    fn any_stamp_is_placed() {
        let mut stamps = Stamps::default();
        for (micros, period) in [(u64::MAX, 0), (0, u64::MAX), (1, 1), (u64::MAX, u64::MAX)] {
            let now = Instant::from_micros(7);
            assert!(stamps.place(now, Stamp { micros, period }) <= now);
        }
    }
}
