//! Reads a number of bytes with an optional unit.

use od_model::values;

/// Reads `1MiB`, `64KiB`, `1025` or `0x400`: a number of bytes below 4 GiB.
pub(crate) fn parse(text: &str) -> Option<u32> {
    let unit = text
        .len()
        .checked_sub(3)
        .and_then(|at| text.split_at_checked(at));
    let (number, factor) = match unit {
        Some((number, unit)) if unit.eq_ignore_ascii_case("KiB") => (number, 1 << 10),
        Some((number, unit)) if unit.eq_ignore_ascii_case("MiB") => (number, 1 << 20),
        _ => (text, 1),
    };
    let bytes = values::integer(number.trim_end())?.checked_mul(factor)?;
    u32::try_from(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn sizes_are_read_with_and_without_a_unit() {
        for (text, bytes) in [
            ("1MiB", Some(1 << 20)),
            ("64kib", Some(65_536)),
            ("64 KiB", Some(65_536)),
            ("0x401", Some(1025)),
            ("0", Some(0)),
            ("4095MiB", Some(4095 << 20)),
            ("4096MiB", None),
            ("-1", None),
            ("1MB", None),
            ("KiB", None),
            ("", None),
        ] {
            assert_eq!(parse(text), bytes, "{text}");
        }
    }
}
