//! REALs as their bits, so that a processor without a floating-point unit needs no library for
//! arithmetic.

use crate::row::Row;
use crate::types::Kind;

/// Functions for a dictionary with REALs. They are pointers in data, so a firmware whose dictionary
/// has no REALs does not contain them.
#[derive(Debug)]
pub struct Reals {
    /// Bits of the REAL32 nearest to a REAL64, rounded as by `as f32`.
    pub narrowed: fn(u64) -> u32,
    /// Bits of the REAL64 with the value of a REAL32.
    pub widened: fn(u32) -> u64,
    /// Whether the first REAL64 is greater than the second; never if one of them is not a number.
    pub is_greater: fn(u64, u64) -> bool,
}

impl Reals {
    /// Functions for a dictionary that may have REALs.
    pub const SOME: Option<&Self> = Some(&Self {
        narrowed,
        widened,
        is_greater,
    });

    /// Functions for a dictionary with these rows; `None` if they have no REALs.
    pub const fn of(rows: &[Row]) -> Option<&'static Self> {
        let mut rest = rows;
        while let [row, others @ ..] = rest {
            if let Kind::Real = row.data_type().kind() {
                return Self::SOME;
            }
            rest = others;
        }
        None
    }
}

/// Number of fraction bits that a REAL64 has and a REAL32 lacks.
const MORE: u32 = 52 - 23;
/// Exponent of a REAL64 that corresponds to exponent 0 of a REAL32.
const LOWEST: u32 = 1023 - 127;

const fn narrowed(double: u64) -> u32 {
    let sign = (double >> 63 << 31) as u32;
    let (exponent, fraction) = ((double >> 52) as u32 & 0x7FF, double & ((1 << 52) - 1));
    if exponent == 0x7FF {
        let quiet = if fraction == 0 { 0 } else { 1 << 22 };
        return sign | 0xFF << 23 | quiet | (fraction >> MORE) as u32;
    }
    if exponent >= LOWEST + 0xFF {
        return sign | 0xFF << 23;
    }
    let (bits, shift) = match exponent.checked_sub(LOWEST) {
        Some(exponent @ 1..) => ((exponent as u64) << 52 | fraction, MORE),
        // Without the implicit bit.
        _ => (fraction | 1 << 52, MORE + 1 + LOWEST - exponent),
    };
    if shift > 54 {
        return sign;
    }
    let (whole, rest, half) = (bits >> shift, bits & ((1 << shift) - 1), 1 << (shift - 1));
    let up = rest > half || rest == half && whole & 1 != 0;
    // A carry into the exponent gives the right result.
    sign | (whole as u32 + up as u32)
}

const fn widened(single: u32) -> u64 {
    let sign = (single as u64) >> 31 << 63;
    let (exponent, fraction) = (single >> 23 & 0xFF, single as u64 & ((1 << 23) - 1));
    let (exponent, fraction) = match (exponent, fraction) {
        (0xFF, _) => (0x7FF, fraction),
        (0, 0) => (0, 0),
        (0, _) => {
            let shift = fraction.leading_zeros() - (63 - 23);
            (LOWEST + 1 - shift, fraction << shift & ((1 << 23) - 1))
        }
        _ => (exponent + LOWEST, fraction),
    };
    sign | (exponent as u64) << 52 | fraction << MORE
}

const fn is_greater(one: u64, other: u64) -> bool {
    const INFINITE: u64 = 0x7FF << 53;
    if one << 1 > INFINITE || other << 1 > INFINITE || (one | other) << 1 == 0 {
        return false;
    }
    ordered(one) > ordered(other)
}

/// Returns a number that sorts as the REAL64 does.
const fn ordered(double: u64) -> u64 {
    match double >> 63 {
        0 => double | 1 << 63,
        _ => !double,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_agree_with_arithmetic() {
        let mut doubles = std::vec![0, 1 << 63, 1, 0x7FF << 52, 0xFFF << 52, f64::NAN.to_bits()];
        let mut seed = 1u64;
        for _ in 0..20_000 {
            seed = seed.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(9);
            // Around the smallest and the greatest single, and anywhere.
            let exponent = [860 + (seed >> 58), 1140 + (seed >> 59), seed >> 53];
            doubles.extend(exponent.map(|e| (e & 0x7FF) << 52 | (seed ^ seed >> 30) << 12 >> 12));
            doubles.push(f64::from(f32::from_bits(seed as u32)).to_bits());
            doubles.push((f64::from(f32::from_bits(seed as u32 >> 9)) * 1.5).to_bits());
        }
        let mut before = 0;
        for double in doubles {
            let value = f64::from_bits(double);
            let single = value as f32;
            assert_eq!(narrowed(double), single.to_bits(), "{value:e}");
            if !single.is_nan() {
                assert_eq!(widened(single.to_bits()), f64::from(single).to_bits());
            }
            assert_eq!(is_greater(double, before), value > f64::from_bits(before));
            assert_eq!(is_greater(before, double), value < f64::from_bits(before));
            before = double;
        }
    }
}
