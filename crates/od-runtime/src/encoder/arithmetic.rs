//! Arithmetic that a small processor can do: exact fractions without numbers of 128 bits, and
//! floating-point numbers without a floating-point unit.

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

    /// Returns the fraction of a number, rounded down, modulo `range` (1 to 2³²).
    pub(super) const fn of(self, number: i64, range: u64) -> u64 {
        let (range, divisor) = (at_least_1(range), at_least_1(self.denominator));
        let (times, rest) = (
            number.unsigned_abs() / divisor % range,
            number.unsigned_abs() % divisor,
        );
        // The number is `times` times the divisor, plus a rest of 0 or more.
        let (times, rest) = match (number < 0, rest) {
            (false, rest) => (times, rest),
            (true, 0) => (range - times, 0),
            (true, rest) => (range - times - 1 + range, divisor - rest),
        };
        let whole = times % range * (self.numerator % range) % range;
        (whole + product(rest, self.numerator, divisor) % range) % range
    }
}

/// Returns `part × number / whole`, rounded down; `part` is less than `whole`.
const fn product(part: u64, number: u64, whole: u64) -> u64 {
    let whole = at_least_1(whole);
    if let Some(product) = part.checked_mul(number) {
        return product / whole;
    }
    let (mut result, mut rest) = (0, 0u64);
    let mut bit = u64::BITS - number.leading_zeros();
    while bit > 0 {
        bit -= 1;
        let is_set = number >> bit & 1 != 0;
        // Both addends are less than `whole`, so `whole` fits into their sum at most once.
        let (twice, over) = subtracted(rest, rest, whole);
        let (sum, again) = if is_set {
            subtracted(twice, part, whole)
        } else {
            (twice, 0)
        };
        rest = sum;
        result = (result << 1) + over + again;
    }
    result
}

/// Returns the sum of two numbers less than `whole` modulo `whole`, and how often `whole` fits
/// into it.
const fn subtracted(one: u64, other: u64, whole: u64) -> (u64, u64) {
    let (sum, carry) = one.overflowing_add(other);
    if carry || sum >= whole {
        (sum.wrapping_sub(whole), 1)
    } else {
        (sum, 0)
    }
}

/// Returns the number, or 1 instead of 0: the compiler sees that nothing is divided by 0.
pub(super) const fn at_least_1(number: u64) -> u64 {
    if number == 0 { 1 } else { number }
}

/// Returns `number / by`, rounded down; a `by` of 0 counts as 1. A shift by the bits of a power
/// of two spares a processor the division of 64 bits.
pub(super) const fn quotient_of(number: u64, by: u64) -> u64 {
    if by.is_power_of_two() {
        number >> by.trailing_zeros()
    } else {
        number / at_least_1(by)
    }
}

/// Returns a number modulo `range`, 0 to `range` − 1; a `range` of 0 counts as 1. A mask spares
/// a processor the division of 64 bits, as in [`quotient_of`].
pub(super) const fn modulo(number: i64, range: u64) -> u64 {
    if range.is_power_of_two() {
        number as u64 & (range - 1)
    } else {
        number.wrapping_rem_euclid(at_least_1(range) as i64) as u64
    }
}

/// Positive number `bits × 2^exponent`, or 0. Every operation rounds down by less than 2⁻³¹ of
/// its result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Float {
    /// The highest bit is set; 0 is the number 0.
    bits: u32,
    exponent: i32,
}

impl Float {
    /// The 32 highest bits of a number.
    pub(super) const fn new(number: u64) -> Self {
        let shift = number.leading_zeros();
        if shift == 64 {
            return Self {
                bits: 0,
                exponent: 0,
            };
        }
        Self {
            bits: ((number << shift) >> 32) as u32,
            exponent: 32 - shift as i32,
        }
    }

    /// Returns the number times 2^`by`.
    pub(super) const fn shifted(self, by: i32) -> Self {
        let exponent = self.exponent + by;
        Self { exponent, ..self }
    }

    /// Returns the product of two numbers.
    pub(super) const fn times(self, other: Self) -> Self {
        let product = self.bits as u64 * other.bits as u64;
        Self::new(product).shifted(self.exponent + other.exponent)
    }

    /// Returns the quotient of two numbers; a division by 0 is one by 1.
    pub(super) const fn over(self, other: Self) -> Self {
        if other.bits == 0 || self.bits == 0 {
            return self;
        }
        if other.bits == 1 << 31 {
            return self.shifted(-31 - other.exponent);
        }
        let exponent = self.exponent - other.exponent - 32;
        if self.bits < other.bits {
            let bits = fraction(self.bits, other.bits);
            Self { bits, exponent }
        } else {
            // Both have the highest bit, so the difference is less than the divisor.
            let rest = fraction(self.bits - other.bits, other.bits);
            let bits = 1 << 31 | rest >> 1;
            Self {
                bits,
                exponent: exponent + 1,
            }
        }
    }

    /// Returns the number in whole units, rounded down; saturates at 2⁶². A number is rounded up
    /// if it is below a whole number by no more than the operations before may have lost.
    pub(super) const fn whole(self) -> i64 {
        /// 2⁻¹³ and one half, in units of 2⁻¹⁶.
        const NEARLY: u64 = 1 << 3;
        const HALF: u64 = 1 << 15;
        if self.bits == 0 {
            return 0;
        }
        if self.exponent > 30 {
            return 1 << 62;
        }
        let fine = if self.exponent > -16 {
            let shift = self.exponent + 16;
            if shift > 31 {
                return (self.bits as i64) << self.exponent;
            }
            (self.bits as u64) << shift
        } else if self.exponent > -48 {
            self.bits as u64 >> (-16 - self.exponent)
        } else {
            0
        };
        // Sixteen operations lose 2⁻²⁷ at most.
        let lost = NEARLY + (fine >> 27);
        ((fine + if lost < HALF { lost } else { HALF }) >> 16) as i64
    }
}

/// Returns `part / whole` in units of 2⁻³², rounded down; `part` is less than `whole`.
///
/// Bit by bit: a processor of 32 bits has no division of 64, and the one of its library is
/// longer.
pub(super) const fn fraction(part: u32, whole: u32) -> u32 {
    let (mut rest, mut bits) = (part, 0u32);
    let mut left = u32::BITS;
    while left > 0 {
        let carry = rest >> 31 != 0;
        rest <<= 1;
        bits <<= 1;
        if carry || rest >= whole {
            rest = rest.wrapping_sub(whole);
            bits |= 1;
        }
        left -= 1;
    }
    bits
}

/// Returns a number times a fraction in units of 2⁻³², rounded down.
pub(super) const fn scaled(number: i64, fraction: u32) -> i64 {
    let (high, low) = (number >> 32, number as u32);
    let low = (low as u64 * fraction as u64) >> 32;
    (high * fraction as i64).wrapping_add(low as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_128_bits() {
        let numbers = [
            0,
            1,
            2,
            3,
            1000,
            65_535,
            1 << 32,
            (1 << 32) + 1,
            999_999_999_989,
            i64::MAX as u64,
            1 << 63,
            u64::MAX - 1,
            u64::MAX,
        ];
        for numerator in numbers {
            for denominator in &numbers[1..] {
                let ratio = Ratio::new(numerator, *denominator);
                for number in numbers {
                    let number = number as i64;
                    let exact = big(number, numerator, *denominator);
                    for range in [1, 2, 1000, 8192, (1 << 32) - 1, 1 << 32] {
                        let expected = exact.rem_euclid(i128::from(range as i64)) as u64;
                        assert_eq!(
                            ratio.of(number, range),
                            expected,
                            "{ratio:?} {number} {range}"
                        );
                    }
                }
            }
        }
        assert_eq!(Ratio::new(7, 0).of(3, 100), 21);
        assert_eq!(Ratio::new(7, 1).of(3, 0), 0);
        assert_eq!(product(0, u64::MAX, 0), 0);
    }

    /// A product of 63 and 64 bits fits into 127 and a sign.
    fn big(number: i64, numerator: u64, denominator: u64) -> i128 {
        (i128::from(number) * i128::from(numerator)).div_euclid(denominator.into())
    }

    #[test]
    fn quotients_are_exact() {
        for (part, whole) in [(0, 1), (1, 3), (999, 1000), (u32::MAX - 1, u32::MAX)] {
            let exact = (u64::from(part) << 32) / u64::from(whole);
            assert_eq!(u64::from(fraction(part, whole)), exact, "{part}/{whole}");
        }
    }

    #[test]
    fn products_and_quotients_are_those_of_whole_numbers() {
        let numbers = [1, 3, 7, 1000, 65_535, 65_536, 999_983, 16_777_213, 1 << 31];
        for a in numbers {
            for b in numbers {
                let (x, y) = (Float::new(a), Float::new(b));
                let product = x.times(y).whole();
                let error = product.abs_diff((a * b) as i64);
                assert!(error <= (a * b) >> 29, "{a} × {b} = {product}");
                // 65,535 / 65,536 is nearly 1, and large numbers are rounded to the nearest.
                let quotient = ((a << 13) + b) / (b << 13);
                let error = x.over(y).whole() - quotient as i64;
                let allowed = i64::from(quotient >= 1 << 20);
                assert!((0..=allowed).contains(&error), "{a} / {b}: {error}");
                assert_eq!(x.times(y).over(y).whole(), a as i64, "{a} × {b} / {b}");
            }
        }
    }

    #[test]
    fn nothing_overflows() {
        let (small, large) = (Float::new(1), Float::new(u64::MAX));
        assert_eq!(large.whole(), 1 << 62);
        assert_eq!(large.times(large).whole(), 1 << 62);
        assert_eq!(small.over(large).over(large).whole(), 0);
        assert_eq!(Float::new(0).times(large).whole(), 0);
        assert_eq!(Float::new(0).over(large).whole(), 0);
        assert_eq!(small.over(Float::new(0)).whole(), 1);
        for shift in -70..70 {
            let exact = match shift {
                ..-31 => 0,
                -31..0 => (1u64 << 31) >> -shift,
                0..31 => (1u64 << 31) << shift,
                _ => 1 << 62,
            };
            let shifted = Float::new(1 << 31).shifted(shift);
            assert_eq!(shifted.whole(), exact as i64, "{shift}");
        }
    }

    #[test]
    fn a_number_is_scaled_exactly() {
        for number in [0, 1, -1, 7 << 40, -(7 << 40) - 3, i64::MAX, i64::MIN] {
            for fraction in [0, 1, 1 << 31, u32::MAX] {
                let exact = (i128::from(number) * i128::from(fraction)) >> 32;
                assert_eq!(i128::from(scaled(number, fraction)), exact);
            }
        }
    }

    /// A power of two takes another way than any other number.
    #[test]
    fn quotients_and_remainders_are_those_of_a_division() {
        for by in [1, 2, 3, 4, 1000, 8192, (1 << 32) - 1, 1 << 32] {
            for number in [0, 1, 2, 4095, 1 << 33, (1 << 40) - 1, i64::MAX] {
                assert_eq!(
                    quotient_of(number as u64, by),
                    number as u64 / by,
                    "{number} {by}"
                );
                for number in [number, -number] {
                    let remainder = number.rem_euclid(by as i64) as u64;
                    assert_eq!(modulo(number, by), remainder, "{number} {by}");
                }
            }
        }
        assert_eq!((quotient_of(5, 0), modulo(-5, 0)), (5, 0));
    }
}
