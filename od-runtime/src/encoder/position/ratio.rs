//! Exact fractions of 64 bits, without arithmetic of 128.

/// Exact fraction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Ratio {
    numerator: u64,
    /// 1 or more.
    denominator: u64,
}

impl Ratio {
    /// Fraction; a denominator of 0 counts as 1.
    pub(super) const fn new(numerator: u64, denominator: u64) -> Self {
        Self {
            numerator,
            denominator: at_least_1(denominator),
        }
    }

    /// The product with a number, rounded down, modulo `range`, which is 1 to 2³².
    #[inline(never)]
    pub(super) const fn of(self, number: i64, range: u64) -> u64 {
        let (range, divisor) = (at_least_1(range), at_least_1(self.denominator));
        let (times, rest) = (
            number.unsigned_abs() / divisor % range,
            number.unsigned_abs() % divisor,
        );
        // The number is `times` times the divisor, and a rest of 0 or more.
        let (times, rest) = match (number < 0, rest) {
            (false, rest) => (times, rest),
            (true, 0) => (range - times, 0),
            (true, rest) => (range - times - 1 + range, divisor - rest),
        };
        let whole = times % range * (self.numerator % range) % range;
        (whole + product(rest, self.numerator, divisor) % range) % range
    }
}

/// `part × number / whole`, rounded down; `part` is less than `whole`.
pub(super) const fn product(part: u64, number: u64, whole: u64) -> u64 {
    let whole = at_least_1(whole);
    if let Some(product) = part.checked_mul(number) {
        return product / whole;
    }
    let (mut result, mut rest) = (0, 0u64);
    let mut bit = u64::BITS - number.leading_zeros();
    while bit > 0 {
        bit -= 1;
        let one = number >> bit & 1 != 0;
        // Both addends are less than `whole`, so that it fits into their sum at most once.
        let (twice, over) = subtracted(rest, rest, whole);
        let (sum, again) = if one {
            subtracted(twice, part, whole)
        } else {
            (twice, 0)
        };
        rest = sum;
        result = (result << 1) + over + again;
    }
    result
}

/// The sum of two numbers less than `whole`, modulo it, and how often it fitted.
const fn subtracted(one: u64, other: u64, whole: u64) -> (u64, u64) {
    let (sum, carry) = one.overflowing_add(other);
    if carry || sum >= whole {
        (sum.wrapping_sub(whole), 1)
    } else {
        (sum, 0)
    }
}

/// A number to divide by.
#[inline(always)] // so that the compiler sees that nothing is divided by 0
pub(in crate::encoder) const fn at_least_1(number: u64) -> u64 {
    if number == 0 { 1 } else { number }
}
