//! From an angle to a position (CiA 406, objects 6000h to 6004h, 6500h to 6502h, 6509h).
//!
//! ```text
//! angle ──> raw ──> resolution ──> gear ──> range ──> code sequence ──> offset ──> 6004h
//!           6501h   6001h          2001h    6002h     6000h bit 0       6509h
//! ```

use super::arithmetic::{Ratio, at_least_1, modulo, quotient_of};

/// Angle of a shaft in 2⁻³² revolutions, from the zero of the sensor; it counts whole revolutions,
/// too.
///
/// Whole revolutions are the upper half, −2³¹ to 2³¹−1; past the ends it wraps.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub struct Angle(i64);

impl Angle {
    /// Zero of the sensor.
    pub const ZERO: Self = Self(0);

    /// Angle of `fractions` 2⁻³² revolutions.
    pub const fn from_fractions(fractions: i64) -> Self {
        Self(fractions)
    }

    /// Returns the angle in 2⁻³² revolutions.
    pub const fn fractions(self) -> i64 {
        self.0
    }

    /// Returns the sum of two angles.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    /// Returns the difference of two angles.
    #[must_use]
    pub const fn minus(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }

    /// Returns whole revolutions, rounded down, and the rest in 2⁻³² revolutions.
    pub const fn split(self) -> (i64, u32) {
        (self.0 >> 32, self.0 as u32)
    }
}

/// Resolution and range of a sensor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sensor {
    /// Steps per revolution, 1 or more.
    pub steps: u32,
    /// Revolutions, 1 or more; 1 is a singleturn.
    pub turns: u32,
}

impl Sensor {
    /// Returns the total number of steps: `steps × turns`.
    pub const fn range(self) -> u64 {
        self.steps as u64 * self.turns as u64
    }

    /// Returns the raw position of the sensor, 0 to [`range`](Self::range) − 1 (CiA 406, object
    /// 600Ch).
    pub const fn raw(self, angle: Angle) -> u64 {
        let (turns, fraction) = angle.split();
        modulo(turns, self.turns as u64) * self.steps as u64 + self.step(fraction)
    }

    /// Returns the angle at which the raw position becomes `raw`, taken modulo the range.
    pub const fn angle(self, raw: u64) -> Angle {
        if self.steps == 0 || self.turns == 0 {
            return Angle::ZERO;
        }
        let steps = self.steps as u64;
        let turn = raw / steps % self.turns as u64;
        let fraction = ((raw % steps) << 32).div_ceil(steps);
        Angle::from_fractions(((turn << 32) + fraction) as i64)
    }

    /// Returns the step within the revolution.
    const fn step(self, fraction: u32) -> u64 {
        (fraction as u64 * self.steps as u64) >> 32
    }
}

/// Scaling of the position: everything that 6004h depends on besides the angle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Scale {
    sensor: Sensor,
    /// Steps per revolution that are shown.
    steps: u64,
    /// Number of positions that are shown, 1 to 2³².
    range: u64,
    /// Number of positions after which counting starts again at 0: `range`, or those of the
    /// sensor if they are fewer.
    wrap: u64,
    /// Whole revolutions count; else the position starts again at 0 with each revolution.
    is_multiturn: bool,
    gear: Option<Ratio>,
    is_reversed: bool,
    /// 0 to `range` − 1.
    offset: u64,
}

impl Scale {
    /// Scaling off: the raw position of the sensor. A range above 2³² is limited to 2³².
    pub const fn unscaled(sensor: Sensor) -> Self {
        Self::new(sensor, sensor.steps, sensor.range())
    }

    /// Scaling to `steps` per revolution (6001h) and positions 0 to `range` − 1 (6002h). Both are
    /// limited to what a position can have: 1 or more, and a `range` of at most 2³².
    pub const fn new(sensor: Sensor, steps: u32, range: u64) -> Self {
        let sensor = Sensor {
            steps: at_least_1(sensor.steps as u64) as u32,
            turns: at_least_1(sensor.turns as u64) as u32,
        };
        let steps = at_least_1(steps as u64);
        let range = match at_least_1(range) {
            range @ ..=0x1_0000_0000 => range,
            _ => 0x1_0000_0000,
        };
        let most = steps.saturating_mul(sensor.turns as u64);
        Self {
            sensor,
            steps,
            range,
            wrap: if range < most { range } else { most },
            is_multiturn: sensor.turns != 1,
            gear: None,
            is_reversed: false,
            offset: 0,
        }
    }

    /// Continues counting past the revolutions of the sensor: the position starts again at 0 after
    /// the range only, also that of a singleturn.
    #[must_use]
    pub const fn counting_on(mut self) -> Self {
        self.is_multiturn = true;
        self.wrap = self.range;
        self
    }

    /// Adds a gear: the count is multiplied by `numerator` and divided by `denominator`, exactly
    /// and rounded down, before the range limits it. A gear counts on
    /// ([`counting_on`](Self::counting_on)); a denominator of 0 counts as 1.
    #[must_use]
    pub const fn with_gear(self, numerator: u64, denominator: u64) -> Self {
        let mut scale = self.counting_on();
        scale.gear = Some(Ratio::new(numerator, denominator));
        scale
    }

    /// Sets the code sequence: counter-clockwise counts up if `is_reversed` (6000h, bit 0).
    #[must_use]
    pub const fn with_code_sequence(mut self, is_reversed: bool) -> Self {
        self.is_reversed = is_reversed;
        self
    }

    /// Sets the offset in steps of this scale (6509h), taken modulo the range.
    #[must_use]
    pub const fn with_offset(mut self, offset: i64) -> Self {
        self.offset = modulo(offset, self.range);
        self
    }

    /// Returns whether the position increases counter-clockwise.
    pub const fn is_reversed(&self) -> bool {
        self.is_reversed
    }

    /// Returns the number of positions that are shown: 1 to 2³².
    pub const fn range(&self) -> u64 {
        self.range
    }

    /// Returns the position at an angle, 0 to range − 1 (CiA 406, object 6004h).
    ///
    /// While a multiturn has power, it counts on past the end of its sensor, so the number of
    /// revolutions need not be a power of two. A singleturn starts again at 0 with each
    /// revolution.
    pub const fn position(&self, angle: Angle) -> u32 {
        let position = self.without_offset(angle) + self.offset;
        if position >= self.range {
            (position - self.range) as u32
        } else {
            position as u32
        }
    }

    /// Returns the position that the angle has with offset 0. Reversed, it is (range − position)
    /// modulo range (MANUALS.md U-06).
    pub const fn without_offset(&self, angle: Angle) -> u64 {
        let (turns, fraction) = angle.split();
        // Both factors are less than 2³².
        let step = quotient_of(
            self.sensor.step(fraction) * self.steps,
            self.sensor.steps as u64,
        );
        let turns = if self.is_multiturn { turns } else { 0 };
        // At most 2³¹ revolutions of less than 2³² steps.
        let count = turns * self.steps as i64 + step as i64;
        let position = match self.gear {
            Some(gear) => gear.of(count, self.range),
            None => modulo(count, self.wrap),
        };
        if self.is_reversed && position != 0 {
            self.range - position
        } else {
            position
        }
    }

    /// Returns the offset with which the angle has this position, 0 to range − 1 (CiA 406, object
    /// 6003h).
    pub const fn offset_for(&self, angle: Angle, position: u32) -> u32 {
        let difference = position as i64 - self.without_offset(angle) as i64;
        modulo(difference, self.range) as u32
    }
}

#[cfg(test)]
mod tests;
