//! A moment at which something is due, or none.

use od_wire::Instant;

use crate::blank::Blank;

/// Time when something is due. `Never` is all zeros, so that a static node takes no flash; the end of time
/// is never, too.
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

    /// Due at this moment, if there is one.
    pub(crate) fn of(at: Option<Instant>) -> Self {
        at.map_or(Self::NEVER, Self::at)
    }

    /// Returns whether something will be due.
    pub(crate) const fn is_set(self) -> bool {
        self.0 != 0
    }

    /// Returns whether it is due by now.
    pub(crate) const fn is_due(self, now: Instant) -> bool {
        is_due(self.0, now.as_micros())
    }

    /// The earlier one of two.
    pub(crate) const fn or(self, other: Self) -> Self {
        Self(earlier(self.0, other.0))
    }

    /// The next one of a period in milliseconds that had one here, after `now`.
    pub(crate) const fn next_period(self, millis: u32, now: Instant) -> Self {
        Self(next(self.0, millis, now.as_micros()))
    }

    /// The moment; the end of time for never.
    pub(crate) const fn moment(self) -> Instant {
        Instant::from_micros(self.0.wrapping_sub(1))
    }
}

// Numbers are in registers, which `Deadline` is not. On a microcontroller they are calls.

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
