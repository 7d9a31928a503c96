//! Arithmetic of the exact shaft.

use od_runtime::encoder::Gain;

/// `amount / by` revolutions, times a gain, in whole units; rounded towards zero.
pub(super) fn exact(amount: i128, by: i128, gain: Gain) -> i64 {
    // A division of 128 bits is slow, and a shaft at constant speed has no acceleration.
    if amount == 0 {
        return 0;
    }
    // An amount is 2⁵⁷ at most (a distance, or a difference of fine speeds), a rate 2⁶⁴.
    let steps = u128::from(gain.steps) << 32;
    let rate = match gain.revolutions {
        0 | 1 => steps,
        revolutions => steps / u128::from(revolutions),
    };
    let steps = nearest(amount * rate as i128, by);
    let value = whole(match (i128::from(gain.multiplier), gain.divider) {
        (factor, 0 | 1) => steps * factor,
        (factor, divider) => nearest(steps * factor, divider.into()),
    });
    value.clamp(i64::MIN.into(), i64::MAX.into()) as i64
}

/// The speed of a shaft at constant speed, with the result of [`exact`].
pub(super) fn even(milli_rpm: i32, gain: Gain) -> i64 {
    const BY: u64 = 60_000;
    let is_plain = gain.revolutions <= 1 && gain.multiplier == 1 && gain.divider <= 1;
    let steps = u64::from(milli_rpm.unsigned_abs()).checked_mul(gain.steps);
    let Some(steps) = steps.filter(|_| is_plain) else {
        return exact(milli_rpm.into(), BY.into(), gain);
    };
    let fraction = (((steps % BY) << 32) + BY / 2) / BY;
    let value = (steps / BY + ((fraction + NEARLY) >> 32)) as i64;
    if milli_rpm < 0 { -value } else { value }
}

/// Division rounded to the nearest, halves away from zero; `by` is more than 0.
const fn nearest(number: i128, by: i128) -> i128 {
    if number < 0 {
        -((by / 2 - number) / by)
    } else {
        (number + by / 2) / by
    }
}

/// 2⁻¹³ steps. A position less than that below a whole step counts as that step, since its fractions were
/// rounded.
const NEARLY: u64 = 1 << 19;

/// Whole steps from 2⁻³² steps, rounded towards zero.
const fn whole(fractions: i128) -> i128 {
    if fractions < 0 {
        -((NEARLY as i128 - fractions) >> 32)
    } else {
        (fractions + NEARLY as i128) >> 32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_speed_is_the_exact_one() {
        let mut seed = 1u64;
        let mut random = |bits: u32| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            seed >> (64 - bits)
        };
        for round in 0..20_000 {
            let bits = 1 + random(5) as u32;
            let gain = Gain {
                multiplier: 1 + (round % 16 == 0) as u32,
                divider: (round % 3) as u32,
                ..Gain::ratio(random(bits), 1 + (round % 7 == 0) as u64)
            };
            let interval = i128::from(1 + random(26));
            for milli_rpm in [random(bits) as i32, -(random(bits) as i32), i32::MIN, 60] {
                let way = i128::from(milli_rpm) * interval;
                let exact = exact(way, 60_000 * interval, gain);
                assert_eq!(even(milli_rpm, gain), exact, "{milli_rpm} {gain:?}");
            }
        }
    }
}
