//! A time at which something is due, or no such time.

use od_wire::Instant;

use crate::blank::Blank;

/// Time when something is due, or never. `NEVER` is all zeros, so that a static node takes no
/// flash. The last instant also means never.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(Rust, packed(4))] // as `Instant`
pub(crate) struct Deadline(u64);

impl Blank for Deadline {
    const BLANK: Self = Self::NEVER;
}

impl Deadline {
    /// Nothing is due.
    pub(crate) const NEVER: Self = Self(0);

    /// Due at this moment.
    pub(crate) const fn at(at: Instant) -> Self {
        Self(at.as_micros().wrapping_add(1))
    }

    /// Due at this time; `None`: never.
    pub(crate) fn of(at: Option<Instant>) -> Self {
        at.map_or(Self::NEVER, Self::at)
    }

    /// Returns whether something will be due.
    pub(crate) const fn is_set(self) -> bool {
        self.0 != 0
    }

    pub(crate) const fn is_due(self, now: Instant) -> bool {
        is_due(self.0, now.as_micros())
    }

    /// Returns the earlier of two deadlines.
    pub(crate) const fn or(self, other: Self) -> Self {
        Self(earlier(self.0, other.0))
    }

    /// Returns the first time after `now` on the grid of a period in milliseconds that includes
    /// this deadline.
    pub(crate) const fn next_period(self, millis: u32, now: Instant) -> Self {
        Self(next(self.0, millis, now.as_micros()))
    }

    /// Returns the time; for never the last instant.
    pub(crate) const fn moment(self) -> Instant {
        Instant::from_micros(self.0.wrapping_sub(1))
    }
}

// These functions take numbers, which fit into registers; a `Deadline` does not.

/// [`Deadline::is_due`].
const fn is_due(at: u64, now: u64) -> bool {
    at != 0 && at - 1 <= now
}

/// [`Deadline::or`].
const fn earlier(one: u64, other: u64) -> u64 {
    if one.wrapping_sub(1) <= other.wrapping_sub(1) {
        one
    } else {
        other
    }
}

/// [`Deadline::next_period`].
const fn next(at: u64, millis: u32, now: u64) -> u64 {
    let (at, now) = (Deadline(at).moment(), Instant::from_micros(now));
    Deadline::at(at.next_period(millis as u64 * 1000, now)).0
}
