//! Fractions against those of 128 bits.

use super::super::ratio::{Ratio, product};

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
