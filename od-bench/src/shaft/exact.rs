//! Arithmetic of the exact shaft.

use od_runtime::encoder::Gain;

/// `amount / by` revolutions, times a gain, in whole units; rounded towards zero.
pub(super) fn exact(amount: i128, by: i128, gain: Gain) -> i64 {
    // An amount is 2⁵⁷ at most (a way, or a difference of fine speeds), a rate 2⁶⁴.
    let rate = (u128::from(gain.steps) << 32) / u128::from(gain.revolutions.max(1));
    let steps = nearest(amount * rate as i128, by);
    let factor = i128::from(gain.multiplier);
    let value = whole(nearest(steps * factor, gain.divider.max(1).into()));
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
