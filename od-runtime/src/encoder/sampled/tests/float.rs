//! Numbers of 32 significant bits against whole ones.

use super::super::float::{Float, quotient};

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
