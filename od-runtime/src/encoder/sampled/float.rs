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
