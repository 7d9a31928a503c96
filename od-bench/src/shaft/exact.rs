//! Arithmetic of the exact shaft.

use od_runtime::encoder::Gain;

/// `amount / by` revolutions, times a gain, in whole units; rounded towards zero.
pub(super) fn exact(amount: i128, by: i128, gain: Gain) -> i64 {
    // A division of 128 bits takes its time, and a shaft that turns evenly has no acceleration.
    if amount == 0 {
        return 0;
    }
    // An amount is 2⁵⁷ at most (a way, or a difference of fine speeds), a rate 2⁶⁴.
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

/// A division to the nearest, halves away from zero; `by` is more than 0.
const fn nearest(number: i128, by: i128) -> i128 {
    if number < 0 {
        -((by / 2 - number) / by)
    } else {
        (number + by / 2) / by
    }
}

/// Whole steps of 2⁻³² steps, towards zero. What lies less than 2⁻¹³ below a whole step is
/// that step: the fractions were rounded on the way.
const fn whole(fractions: i128) -> i128 {
    const NEARLY: i128 = 1 << 19;
    if fractions < 0 {
        -((NEARLY - fractions) >> 32)
    } else {
        (fractions + NEARLY) >> 32
    }
}
