//! Positions that a host sets one after another: a movement of the shaft.

use std::collections::VecDeque;

use od_runtime::Instant;
use od_runtime::encoder::Angle;

use super::course::PER_REVOLUTION;

/// The longest time between two positions of one movement, in microseconds. A position that
/// comes later is a jump, which has no duration and no speed.
const LONGEST: u64 = 20_000;

/// Distance of a shaft by set positions, in addition to that of its course.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub(super) struct Placed {
    /// Moments with the distance from the first position.
    ways: VecDeque<(Instant, Angle)>,
    /// Time for which positions are remembered, in microseconds.
    interval: u32,
}

impl Placed {
    pub(super) const fn new() -> Self {
        Self {
            ways: VecDeque::new(),
            interval: 0,
        }
    }

    /// Remembers the positions of the last `interval` microseconds.
    pub(super) fn look_back(&mut self, interval: u32) {
        self.interval = interval;
    }

    /// Adds a position at a distance of `by` from the previous angle.
    pub(super) fn add(&mut self, now: Instant, by: Angle) {
        let way = match self.ways.back() {
            Some((last, _)) if *last >= now => return,
            Some((last, way)) if now.micros_since(*last) <= LONGEST => way.plus(by),
            Some((_, way)) => *way,
            None => Angle::ZERO,
        };
        self.ways.push_back((now, way));
        let is_old = |at: &Instant| now.micros_since(*at) > self.interval.into();
        while self.ways.get(1).is_some_and(|(at, _)| is_old(at)) {
            self.ways.pop_front();
        }
    }

    /// Returns whether no position is remembered.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.ways.is_empty()
    }

    /// The distance between two moments in thousandths of a revolution per minute times
    /// microseconds, with a constant speed between two positions.
    pub(super) fn way(&self, from: Instant, to: Instant) -> i128 {
        if self.ways.is_empty() {
            return 0;
        }
        let fractions = self.fine_way(to) - self.fine_way(from);
        (fractions * i128::from(PER_REVOLUTION) + (1 << 51)) >> 52
    }

    /// The distance up to a moment, in 2⁻⁵² revolutions.
    fn fine_way(&self, at: Instant) -> i128 {
        let later = self.ways.partition_point(|(moment, _)| *moment <= at);
        let way = |index| match self.ways.get(index) {
            Some((at, way)) => (*at, i128::from(way.fractions()) << 20),
            None => (Instant::ZERO, 0),
        };
        if later == 0 || later == self.ways.len() {
            return way(later.saturating_sub(1)).1;
        }
        let ((before, start), (after, end)) = (way(later - 1), way(later));
        let passed = i128::from(at.micros_since(before));
        start + (end - start) * passed / i128::from(after.micros_since(before).max(1))
    }
}
