//! Time of a counter that wraps.

use od_runtime::{Duration, Instant};

/// Time of a counter with `HZ` ticks per second and `BITS` bits, at most 32, that starts again at
/// 0.
///
/// Call [`at`](Self::at) at least once in each round of the counter (71 minutes for 32 bits at 1 MHz);
/// [`Clock::LONGEST`] is a good limit for a sleep. The conversion to microseconds loses no tick,
/// however long the clock runs.
///
/// ```
/// use od_board::Clock;
///
/// let mut clock: Clock = Clock::new();
/// assert_eq!(clock.at(u32::MAX).as_micros(), 4_294_967_295);
/// assert_eq!(clock.at(4).as_micros(), 4_294_967_300);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Clock<const HZ: u32 = 1_000_000, const BITS: u32 = 32> {
    ticks: u32,
    micros: u64,
    /// Remainder below a microsecond, in units of `1 / DIVISOR`.
    rest: u64,
}

impl<const HZ: u32, const BITS: u32> Clock<HZ, BITS> {
    /// Half of the time after which the counter wraps.
    pub const LONGEST: Duration =
        Duration::from_micros((1 << (BITS - 1)) * Self::FACTOR / Self::DIVISOR);
    const MASK: u32 = u32::MAX >> (32 - BITS);
    const COMMON: u64 = {
        let (mut a, mut b) = (1_000_000, HZ as u64);
        assert!(b > 0, "HZ is above 0");
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    const FACTOR: u64 = 1_000_000 / Self::COMMON;
    const DIVISOR: u64 = HZ as u64 / Self::COMMON;

    /// A clock at 0, for a counter at 0.
    pub const fn new() -> Self {
        Self {
            ticks: 0,
            micros: 0,
            rest: 0,
        }
    }

    /// Returns the time at which the counter shows `ticks`. A value lower than the last one means
    /// that the counter has wrapped.
    pub const fn at(&mut self, ticks: u32) -> Instant {
        let passed = (ticks.wrapping_sub(self.ticks) & Self::MASK) as u64;
        self.ticks = ticks;
        let parts = passed * Self::FACTOR + self.rest;
        self.micros = self.micros.wrapping_add(parts / Self::DIVISOR);
        self.rest = parts % Self::DIVISOR;
        Instant::from_micros(self.micros)
    }
}
