//! Virtual time: a count of microseconds that the caller owns.

use core::fmt;
use core::ops::{Add, Sub};

pub use core::time::Duration;

/// A point in time, in microseconds since an origin that the caller chooses (for example power-on).
///
/// Only the host reads a clock; time is an argument of all other code.
///
/// ```
/// use od_wire::{Duration, Instant};
///
/// let at = Instant::from_millis(100) + Duration::from_millis(5);
/// assert_eq!(at.as_micros(), 105_000);
/// assert_eq!(at - Instant::from_millis(100), Duration::from_millis(5));
/// ```
// Packed: otherwise every struct with an `Instant` has gaps of four bytes on a microcontroller.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(Rust, packed(4))]
pub struct Instant(u64);

impl Instant {
    /// The origin.
    pub const ZERO: Self = Self(0);
    /// The last instant, 584,000 years after the origin. Nothing is ever due then.
    pub const MAX: Self = Self(u64::MAX);

    /// `micros` microseconds after the origin.
    pub const fn from_micros(micros: u64) -> Self {
        Self(micros)
    }

    /// `millis` milliseconds after the origin.
    pub const fn from_millis(millis: u64) -> Self {
        Self(millis.saturating_mul(1000))
    }

    /// Microseconds since the origin.
    pub const fn as_micros(self) -> u64 {
        self.0
    }

    /// The moment `millis` milliseconds later.
    pub const fn plus_millis(self, millis: u64) -> Self {
        self.plus_micros(millis.saturating_mul(1000))
    }

    /// The moment `micros` microseconds later; at most the last instant.
    pub const fn plus_micros(self, micros: u64) -> Self {
        Self(later(self.0, micros))
    }

    /// Microseconds since `earlier`; 0 if that is later.
    pub const fn micros_since(self, earlier: Self) -> u64 {
        self.0.saturating_sub(earlier.0)
    }

    /// The next moment after `now` on the grid of a period of `micros` that includes `self`.
    ///
    /// A late caller gets one moment, not one for each missed period.
    pub const fn next_period(self, micros: u64, now: Self) -> Self {
        let next = self.plus_micros(micros);
        if next.0 > now.0 {
            return next;
        }
        let micros = if micros == 0 { 1 } else { micros };
        // Computes the remainder bit by bit, since a microcontroller has no division of 64 bits.
        let (mut late, mut rest, mut bits) = (now.0 - self.0, 0, u64::BITS);
        while bits > 0 {
            rest = rest << 1 | late >> 63;
            if rest >= micros {
                rest -= micros;
            }
            late <<= 1;
            bits -= 1;
        }
        now.plus_micros(micros - rest)
    }
}

/// The sum, or the last instant. Not inlined, since that takes 248 to 524 more bytes of flash
/// (Cortex-M3, `s`).
#[inline(never)]
const fn later(at: u64, micros: u64) -> u64 {
    at.saturating_add(micros)
}

impl Add<Duration> for Instant {
    type Output = Self;
    fn add(self, duration: Duration) -> Self {
        self.plus_micros(u64::try_from(duration.as_micros()).unwrap_or(u64::MAX))
    }
}

impl Sub for Instant {
    type Output = Duration;
    fn sub(self, earlier: Self) -> Duration {
        Duration::from_micros(self.micros_since(earlier))
    }
}

impl fmt::Debug for Instant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:06}", self.0 / 1_000_000, self.0 % 1_000_000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_caller_gets_one_tick() {
        let at = |ms| Instant::from_millis(ms);
        assert_eq!(at(10).next_period(5_000, at(10)), at(15));
        assert_eq!(at(10).next_period(5_000, at(12)), at(15));
        assert_eq!(at(10).next_period(5_000, at(15)), at(20));
        assert_eq!(at(10).next_period(5_000, at(31)), at(35));
        assert_eq!(at(10).next_period(0, at(31)), Instant::from_micros(31_001));
    }
}
