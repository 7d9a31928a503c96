//! Angle by which a shaft turns at constant speed, in 2⁻³² revolutions, rounded down as in the exact arithmetic.

use super::course::PER_REVOLUTION;

/// The divisor of a distance without its powers of two.
const ODD: u64 = PER_REVOLUTION >> PER_REVOLUTION.trailing_zeros();

/// Microseconds for which the products of a [`Rate`] are exact: six days. In this time the error is less than
/// one part of [`ODD`].
const MOST: u64 = u64::MAX / ODD;

/// A constant speed, as the angle per microsecond.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Rate {
    /// Whole 2⁻³² revolutions per microsecond.
    whole: u64,
    /// The fraction of that unit in 2⁻⁶⁴, rounded up.
    part: u64,
    /// All bits 1 for a negative speed, else 0.
    sign: i64,
    /// Microseconds for which it is exact; 0 if the speed is not constant.
    most: u64,
}

impl Rate {
    /// The rate of a speed that is not constant.
    pub(super) const NONE: Self = Self {
        whole: 0,
        part: 0,
        sign: 0,
        most: 0,
    };

    /// The rate of a speed in thousandths of a revolution per minute.
    pub(super) const fn even(milli_rpm: i32) -> Self {
        const { assert!(PER_REVOLUTION.trailing_zeros() <= 32) };
        let fractions =
            (milli_rpm.unsigned_abs() as u128) << (32 - PER_REVOLUTION.trailing_zeros());
        let rate = (fractions << 64).div_ceil(ODD as u128);
        Self {
            whole: (rate >> 64) as u64,
            part: rate as u64,
            sign: if milli_rpm < 0 { -1 } else { 0 },
            most: MOST,
        }
    }

    /// The angle in this many microseconds, if the rate is exact for them.
    #[inline]
    pub(super) fn turned(&self, micros: u64) -> Option<i64> {
        if micros >= self.most {
            return None;
        }
        let part = ((u128::from(micros) * u128::from(self.part)) >> 64) as u64;
        let turned = micros.wrapping_mul(self.whole).wrapping_add(part) as i64;
        Some((turned ^ self.sign).wrapping_sub(self.sign))
    }
}

impl Default for Rate {
    fn default() -> Self {
        Self::even(0)
    }
}

/// The angle in any time at this speed.
pub(super) fn turned(milli_rpm: i32, micros: u64) -> i64 {
    let way = u128::from(milli_rpm.unsigned_abs()) * u128::from(micros);
    // Revolutions above 2³² do not matter, since the angle wraps.
    let turned = ((way << 32) / u128::from(PER_REVOLUTION)) as i64;
    turned.wrapping_mul(milli_rpm.signum().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_exact() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            seed.rotate_left(32)
        };
        for round in 0..100_000 {
            let milli_rpm = (random() as i32) >> (round % 32);
            let micros = (random() % MOST) >> (round % 39);
            // Also near whole quotients.
            let speed = u64::from(milli_rpm.unsigned_abs()).max(1);
            let begins = ((u128::from(micros) * u128::from(speed)) << 21).div_ceil(ODD.into());
            let begins = (begins * u128::from(ODD)).div_ceil(u128::from(speed) << 21) as u64;
            for micros in [micros, begins.min(MOST - 1), begins - u64::from(begins > 0)] {
                let exact = turned(milli_rpm, micros);
                let rate = Rate::even(milli_rpm);
                assert_eq!(rate.turned(micros), Some(exact), "{milli_rpm} {micros}");
            }
        }
    }

    #[test]
    fn a_rate_says_where_it_ends() {
        for milli_rpm in [i32::MIN, -1, 0, 1, 60_000, i32::MAX] {
            let rate = Rate::even(milli_rpm);
            assert_eq!(rate.turned(MOST - 1), Some(turned(milli_rpm, MOST - 1)));
            assert_eq!(rate.turned(MOST), None);
        }
        assert_eq!(Rate::NONE.turned(0), None);
        // Three hundred thousand years at full speed do not panic.
        let _ = turned(i32::MIN, u64::MAX);
    }
}
