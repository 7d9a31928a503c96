//! From an angle to a position (CiA 406: objects 6000h–6004h, 6500h–6502h, 6509h).
//!
//! ```text
//! angle ──> raw ──> resolution ──> gear ──> range ──> sense of rotation ──> offset ──> 6004h
//!           6501h   6001h          2001h    6002h     6000h bit 0           6509h
//! ```

pub(super) mod ratio;

use super::angle::Angle;
use crate::device::ROOMY;
use ratio::{Ratio, at_least_1};

/// Resolution and range of a sensor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sensor {
    /// Steps per revolution, 1 or more.
    pub steps: u32,
    /// Revolutions, 1 or more; 1 is a singleturn.
    pub turns: u32,
}

impl Sensor {
    /// Steps in all: `steps × turns`.
    pub const fn range(self) -> u64 {
        self.steps as u64 * self.turns as u64
    }

    /// The sensor's own position, 0 to [`range`](Self::range) − 1.
    #[inline]
    pub const fn raw(self, angle: Angle) -> u64 {
        let (turns, fraction) = angle.split();
        let turn = turns.wrapping_rem_euclid(at_least_1(self.turns as u64) as i64);
        turn as u64 * self.steps as u64 + self.step(fraction)
    }

    /// The angle where the sensor begins to say `raw`; past its range it goes on with 0.
    pub const fn angle(self, raw: u64) -> Angle {
        if self.steps == 0 || self.turns == 0 {
            return Angle::ZERO;
        }
        let steps = self.steps as u64;
        let turn = raw / steps % self.turns as u64;
        let fraction = ((raw % steps) << 32).div_ceil(steps);
        Angle::from_fractions(((turn << 32) + fraction) as i64)
    }

    /// Step within the revolution.
    #[inline]
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
    /// Positions that are shown, 1 to 2³².
    range: u64,
    /// Positions after which counting starts again at 0: `range`, or those of the sensor if that
    /// is less.
    wrap: u64,
    /// `wrap` − 1 where `wrap` is a power of two, else 0: a mask is faster than a division.
    mask: u64,
    step: Step,
    /// Revolutions count; else each starts again at 0.
    counts: bool,
    gear: Option<Ratio>,
    reversed: bool,
    /// 0 to `range` − 1.
    offset: u64,
    /// The same in short, where there is room for it.
    powers: [Powers; ROOMY as usize],
}

/// A [`Scale`] of powers of two alone: what it shows are bits of the angle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Powers {
    /// Bits of a revolution that are finer than a step.
    finer: u8,
    /// All ones where the sense is reversed, else 0.
    reversed: u32,
    offset: u32,
    /// Positions that are shown, less one; 0 where the scale is another one.
    mask: u32,
}

impl Powers {
    const NONE: Self = Self {
        finer: 0,
        reversed: 0,
        offset: 0,
        mask: 0,
    };

    const fn of(scale: &Scale) -> Self {
        let (sensor, steps) = (scale.sensor.steps, scale.steps);
        let is_one = sensor.is_power_of_two()
            && steps.is_power_of_two()
            && steps <= sensor as u64
            && scale.wrap == scale.range;
        if !is_one {
            return Self::NONE;
        }
        Self {
            finer: (32 - steps.trailing_zeros()) as u8,
            reversed: if scale.reversed { u32::MAX } else { 0 },
            offset: scale.offset as u32,
            mask: scale.mask as u32,
        }
    }
}

/// Conversion of a step of the sensor into one that is shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Step {
    Same,
    /// The sensor's steps per revolution are this power of two.
    Shift(u32),
    Divide,
}

impl Scale {
    /// Shows the sensor as it is. A range past 2³² is cut there.
    pub const fn unscaled(sensor: Sensor) -> Self {
        Self::new(sensor, sensor.steps, sensor.range())
    }

    /// Shows `steps` a revolution (6001h) and positions 0 to `range` − 1 (6002h).
    ///
    /// Both are brought into what can be computed with: 1 or more, `range` at most 2³².
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
        let wrap = if range < most { range } else { most };
        Self {
            sensor,
            steps,
            range,
            wrap,
            mask: if wrap.is_power_of_two() { wrap - 1 } else { 0 },
            step: if steps == sensor.steps as u64 {
                Step::Same
            } else if sensor.steps.is_power_of_two() {
                Step::Shift(sensor.steps.trailing_zeros())
            } else {
                Step::Divide
            },
            counts: sensor.turns != 1,
            gear: None,
            reversed: false,
            offset: 0,
            powers: [Powers::NONE; ROOMY as usize],
        }
        .in_short()
    }

    /// With its short form, when all else is set.
    const fn in_short(mut self) -> Self {
        let powers = Powers::of(&self);
        if let [short, ..] = self.powers.as_mut_slice() {
            *short = powers;
        }
        self
    }

    /// Counts on past the revolutions of the sensor: only the range decides when it starts
    /// again at 0, for a singleturn, too.
    #[must_use]
    pub const fn counting_on(mut self) -> Self {
        self.counts = true;
        self.wrap = self.range;
        self.mask = if self.wrap.is_power_of_two() {
            self.wrap - 1
        } else {
            0
        };
        self.in_short()
    }

    /// The count is multiplied by `numerator` and divided by `denominator`, exactly
    /// and rounded down, before it is brought into the range. Counts on
    /// ([`counting_on`](Self::counting_on)); a denominator of 0 counts as 1.
    #[must_use]
    pub const fn with_gear(self, numerator: u64, denominator: u64) -> Self {
        let mut scale = self.counting_on();
        scale.mask = 0;
        scale.gear = Some(Ratio::new(numerator, denominator));
        scale.in_short()
    }

    /// With the sense of rotation: counter-clockwise counts up if `reversed`.
    #[must_use]
    pub const fn with_sense(mut self, reversed: bool) -> Self {
        self.reversed = reversed;
        self.in_short()
    }

    /// With an offset in steps of this scale; any number, taken modulo the range.
    #[must_use]
    pub const fn with_offset(mut self, offset: i64) -> Self {
        self.offset = self.in_range(offset);
        self.in_short()
    }

    /// Returns whether the position increases counter-clockwise.
    pub const fn is_reversed(&self) -> bool {
        self.reversed
    }

    /// Positions that are shown: 1 to 2³².
    pub const fn range(&self) -> u64 {
        self.range
    }

    /// The position at an angle: 0 to range − 1.
    ///
    /// A multiturn goes on counting past the end of its sensor as long as it has
    /// power, so the number of revolutions need not be a power of two. A singleturn
    /// starts again at 0 with each revolution.
    #[inline]
    pub const fn position(&self, angle: Angle) -> u32 {
        self.shown(self.without_offset(angle))
    }

    /// The position that a count is shown as.
    #[inline]
    pub(super) const fn shown(&self, count: u64) -> u32 {
        let position = count + self.offset;
        if position >= self.range {
            (position - self.range) as u32
        } else {
            position as u32
        }
    }

    /// The position as it would be with offset 0.
    #[inline]
    pub const fn without_offset(&self, angle: Angle) -> u64 {
        self.count(angle, true)
    }

    /// As [`position`](Self::position), where it needs no division and no gear turns.
    #[inline(always)]
    pub(super) const fn quick_position(&self, angle: Angle) -> Option<u32> {
        if let [powers, ..] = self.powers.as_slice()
            && powers.mask != 0
        {
            let steps = (angle.fractions() >> (powers.finer & 63)) as u32;
            let steps = (steps ^ powers.reversed).wrapping_sub(powers.reversed);
            return Some(steps.wrapping_add(powers.offset) & powers.mask);
        }
        match self.quick_count(angle) {
            Some(count) => Some(self.shown(count)),
            None => None,
        }
    }

    /// As [`without_offset`](Self::without_offset), where powers of two need no division and no gear turns.
    #[inline(always)]
    const fn quick_count(&self, angle: Angle) -> Option<u64> {
        let (turns, fraction) = angle.split();
        let step = self.sensor.step(fraction);
        let step = match self.step {
            Step::Same => step,
            Step::Shift(bits) => (step * self.steps) >> bits,
            Step::Divide => return None,
        };
        if self.mask == 0 {
            return None;
        }
        let turns = if self.counts { turns } else { 0 };
        let position = (turns * self.steps as i64 + step as i64) as u64 & self.mask;
        Some(if self.reversed && position != 0 {
            self.range - position
        } else {
            position
        })
    }

    /// As [`without_offset`](Self::without_offset), without code for a gear where there can be none.
    #[inline(always)]
    pub(super) const fn count(&self, angle: Angle, may_have_gear: bool) -> u64 {
        let (turns, fraction) = angle.split();
        let step = self.sensor.step(fraction);
        // Both factors are less than 2³².
        let step = match self.step {
            Step::Same => step,
            Step::Shift(bits) => (step * self.steps) >> bits,
            Step::Divide => step * self.steps / at_least_1(self.sensor.steps as u64),
        };
        let total = if self.counts {
            // At most 2³¹ revolutions of less than 2³² steps.
            turns * self.steps as i64 + step as i64
        } else {
            step as i64
        };
        let position = if self.mask != 0 {
            total as u64 & self.mask
        } else if may_have_gear && let Some(gear) = self.gear {
            gear.of(total, self.range)
        } else {
            total.wrapping_rem_euclid(at_least_1(self.wrap) as i64) as u64
        };
        if self.reversed && position != 0 {
            self.range - position
        } else {
            position
        }
    }

    /// The offset that makes the position at `angle` this one, 0 to range − 1.
    pub const fn offset_for(&self, angle: Angle, position: u32) -> u32 {
        self.offset_from(self.without_offset(angle), position)
    }

    /// The offset that makes a count this position.
    pub(super) const fn offset_from(&self, count: u64, position: u32) -> u32 {
        let difference = position as i64 - count as i64;
        self.in_range(difference) as u32
    }

    /// A number modulo the range.
    const fn in_range(&self, number: i64) -> u64 {
        number.wrapping_rem_euclid(at_least_1(self.range) as i64) as u64
    }
}

#[cfg(test)]
mod tests;
