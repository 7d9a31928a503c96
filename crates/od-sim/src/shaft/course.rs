//! Course of a shaft: its speed over the integration time of a speed or an acceleration.
//!
//! Distances are in thousandths of a revolution per minute times microseconds. A turn of the shaft by a user has no
//! duration and is not part of the course.

use od_runtime::Instant;

/// The distance of one revolution.
pub(super) const PER_REVOLUTION: u64 = 60_000_000_000;

/// Number of remembered changes of speed: 640 ms with a change every 10 ms.
const PIECES: usize = 64;

/// Factor of a fine speed, so that fractions of a thousandth are not lost.
pub(super) const FINE: i128 = 1 << 20;

/// A speed that changes evenly.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Ramp {
    /// Duration; 0: the speed does not change.
    pub(super) micros: u32,
    /// Total change.
    pub(super) by: i64,
}

impl Ramp {
    /// A speed that does not change.
    pub(super) const NONE: Self = Self { micros: 0, by: 0 };

    /// The speed at the end of the change, which begins with the speed `from`.
    pub(super) const fn to(self, from: i32) -> i32 {
        // The sum is the requested speed.
        (from as i64 + self.by) as i32
    }

    /// The speed after `micros`, rounded to whole thousandths.
    pub(super) fn speed(self, from: i32, micros: u64) -> i32 {
        let fine = self.fine_speed(from, micros);
        (fine + FINE / 2).div_euclid(FINE) as i32
    }

    /// The speed after `micros` times [`FINE`], rounded.
    fn fine_speed(self, from: i32, micros: u64) -> i128 {
        if micros >= u64::from(self.micros) {
            return i128::from(self.to(from)) * FINE;
        }
        let changed = i128::from(self.by) * FINE * i128::from(micros);
        i128::from(from) * FINE + rounded(changed, self.micros.into())
    }

    /// The distance in the first `micros`, rounded.
    pub(super) fn way(self, from: i32, micros: u64) -> i128 {
        let all = i128::from(self.micros);
        let ramped = i128::from(micros.min(self.micros.into()));
        let rest = i128::from(micros.saturating_sub(self.micros.into()));
        let even = i128::from(from) * ramped + i128::from(self.to(from)) * rest;
        if all == 0 {
            return even;
        }
        even + rounded(i128::from(self.by) * ramped * ramped, 2 * all)
    }
}

/// Division by a positive number, rounded to the nearest.
const fn rounded(number: i128, by: i128) -> i128 {
    (number + by / 2).div_euclid(by)
}

/// A time in which the speed is constant, or changes evenly and is then constant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Piece {
    since: Instant,
    milli_rpm: i32,
    ramp: Ramp,
}

/// The last changes of speed, oldest first in a ring.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Course {
    pieces: [Piece; PIECES],
    /// Index of the newest.
    newest: u8,
    /// Number of pieces, 1 or more.
    len: u8,
}

impl Default for Course {
    fn default() -> Self {
        Self::AT_REST
    }
}

impl Course {
    /// Course of a shaft that never turned.
    pub(super) const AT_REST: Self = Self {
        pieces: [Piece {
            since: Instant::ZERO,
            milli_rpm: 0,
            ramp: Ramp::NONE,
        }; PIECES],
        newest: 0,
        len: 1,
    };

    /// Sets the speed from `since` on; it replaces an earlier change at the same moment.
    pub(super) fn add(&mut self, since: Instant, milli_rpm: i32, ramp: Ramp) {
        let newest = &self.pieces[usize::from(self.newest) % PIECES];
        if newest.since < since {
            let same = newest.ramp == Ramp::NONE && newest.milli_rpm == milli_rpm;
            if same && ramp == Ramp::NONE {
                return;
            }
            self.newest = (self.newest + 1) % PIECES as u8;
            self.len = (self.len + 1).min(PIECES as u8);
        }
        self.pieces[usize::from(self.newest) % PIECES] = Piece {
            since,
            milli_rpm,
            ramp,
        };
    }

    /// The pieces, newest first.
    fn pieces(&self) -> impl Iterator<Item = &Piece> {
        let at = |back: u8| (usize::from(self.newest) + PIECES - usize::from(back)) % PIECES;
        (0..self.len).map(move |back| &self.pieces[at(back)])
    }

    /// The distance between two moments. Before the first remembered piece the speed is that at
    /// its beginning.
    pub(super) fn way(&self, from: Instant, to: Instant) -> i128 {
        let (mut way, mut until) = (0, to);
        for (back, piece) in (1..).zip(self.pieces()) {
            if until <= from {
                break;
            }
            let is_oldest = back == self.len;
            let start = if is_oldest {
                from
            } else {
                piece.since.max(from)
            };
            if start < until {
                way += piece.way(start, until);
                until = start;
            }
        }
        way
    }

    /// The speed, if it was the same since `from`.
    #[inline]
    pub(super) fn even_since(&self, from: Instant) -> Option<i32> {
        let newest = &self.pieces[usize::from(self.newest) % PIECES];
        let is_even = newest.ramp.micros == 0 && newest.since <= from;
        is_even.then_some(newest.milli_rpm)
    }

    /// The speed at a moment, times [`FINE`]; with a change at that moment, the new one.
    pub(super) fn fine_speed(&self, at: Instant) -> i128 {
        let piece = self.pieces().find(|piece| piece.since <= at);
        match piece {
            Some(piece) => piece
                .ramp
                .fine_speed(piece.milli_rpm, at.micros_since(piece.since)),
            None => {
                let oldest = self.pieces().last();
                oldest.map_or(0, |piece| i128::from(piece.milli_rpm) * FINE)
            }
        }
    }
}

impl Piece {
    /// The distance from `from` to `to`; time before the piece has its first speed.
    fn way(&self, from: Instant, to: Instant) -> i128 {
        let before = i128::from(self.since.min(to).micros_since(from.min(self.since)));
        let until = |at: Instant| self.ramp.way(self.milli_rpm, at.micros_since(self.since));
        i128::from(self.milli_rpm) * before + until(to) - until(from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    #[test]
    fn ways_and_speeds_over_changes() {
        let mut course = Course::AT_REST;
        assert_eq!(course.way(ms(0), ms(100)), 0);
        course.add(ms(100), 1000, Ramp::NONE);
        course.add(ms(200), 7, Ramp::NONE);
        course.add(ms(200), -500, Ramp::NONE);
        assert_eq!(course.way(ms(150), ms(250)), 1000 * 50_000 - 500 * 50_000);
        assert_eq!(course.way(ms(0), ms(300)), 1000 * 100_000 - 500 * 100_000);
        assert_eq!(course.way(ms(110), ms(120)), 1000 * 10_000);
        let speeds = [99, 100, 199, 200].map(|at| course.fine_speed(ms(at)) / FINE);
        assert_eq!(speeds, [0, 1000, 1000, -500]);
    }

    #[test]
    fn a_ramp_is_a_square() {
        let mut course = Course::AT_REST;
        let ramp = Ramp {
            micros: 1_000_000,
            by: -3000,
        };
        course.add(ms(0), 1000, ramp);
        assert_eq!(course.fine_speed(ms(500)), -500 * FINE);
        assert_eq!(course.fine_speed(ms(2000)), -2000 * FINE);
        // 1000 t − 1500 t², t in seconds.
        assert_eq!(course.way(ms(0), ms(500)), 125_000_000);
        assert_eq!(course.way(ms(500), ms(1000)), -625_000_000);
        assert_eq!(course.way(ms(1000), ms(1001)), -2_000_000);
    }

    #[test]
    fn before_the_oldest_piece_the_speed_was_the_same() {
        let mut course = Course::AT_REST;
        for step in 1..=100u32 {
            course.add(ms(u64::from(step) * 10), step as i32, Ramp::NONE);
        }
        // 64 pieces: 37 to 100.
        assert_eq!(course.fine_speed(ms(370)), 37 * FINE);
        assert_eq!(course.fine_speed(ms(5)), 37 * FINE);
        assert_eq!(course.way(ms(360), ms(380)), 37 * 20_000);
        assert_eq!(course.way(ms(990), ms(1010)), (99 + 100) * 10_000);
        // The same speed again does not add a piece.
        course.add(ms(2000), 100, Ramp::NONE);
        assert_eq!(course.fine_speed(ms(370)), 37 * FINE);
    }
}
