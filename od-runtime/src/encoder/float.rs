//! Numbers of 32 significant bits, for processors without a floating-point unit and without a
//! division of 64 bits.

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

    /// The number times 2^`by`.
    pub(super) const fn shifted(self, by: i32) -> Self {
        let exponent = self.exponent + by;
        Self { exponent, ..self }
    }

    pub(super) const fn times(self, other: Self) -> Self {
        let product = self.bits as u64 * other.bits as u64;
        Self::new(product).shifted(self.exponent + other.exponent)
    }

    /// The quotient; a division by 0 is one by 1.
    pub(super) const fn over(self, other: Self) -> Self {
        if other.bits == 0 || self.bits == 0 {
            return self;
        }
        if other.bits == 1 << 31 {
            return self.shifted(-31 - other.exponent);
        }
        let exponent = self.exponent - other.exponent - 32;
        if self.bits < other.bits {
            let bits = quotient(self.bits, other.bits);
            Self { bits, exponent }
        } else {
            // Both have the highest bit, so the difference is less than the divisor.
            let rest = quotient(self.bits - other.bits, other.bits);
            let bits = 1 << 31 | rest >> 1;
            Self {
                bits,
                exponent: exponent + 1,
            }
        }
    }

    /// The number in whole units, rounded down; but what is below a whole number by no more
    /// than the operations before may have lost is that number. Saturates at 2⁶².
    pub(super) const fn whole(self) -> i64 {
        /// 2⁻¹³ and a half, in units of 2⁻¹⁶.
        const NEARLY: u64 = 1 << 3;
        const HALF: u64 = 1 << 15;
        if self.bits == 0 {
            return 0;
        }
        if self.exponent > 30 {
            return 1 << 62;
        }
        let fine = if self.exponent > -16 {
            // 32 bits shifted by 46 at most: saturates far below.
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

/// `part / whole` in units of 2⁻³², rounded down; `part` is less than `whole`.
pub(super) const fn quotient(part: u32, whole: u32) -> u32 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_exact() {
        for (part, whole) in [(0, 1), (1, 3), (999, 1000), (u32::MAX - 1, u32::MAX)] {
            let exact = (u64::from(part) << 32) / u64::from(whole);
            assert_eq!(u64::from(quotient(part, whole)), exact, "{part}/{whole}");
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
}
