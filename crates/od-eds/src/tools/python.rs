//! Python's numbers: `int`, `float` and `bytes.fromhex`.

use alloc::string::String;
use alloc::vec::Vec;

/// Returns whether Python's `str` treats it as a blank.
pub(crate) fn is_space(c: char) -> bool {
    c.is_whitespace() || ('\x1c'..='\x1f').contains(&c)
}

/// `str.strip`
pub(crate) fn strip(text: &str) -> &str {
    text.trim_matches(is_space)
}

/// `int(text, base)` for base 0, 2, 10 and 16; a number beyond 127 bits is cut.
pub(crate) fn int(text: &str, base: u32) -> Option<i128> {
    let text = strip(text);
    let (negative, digits) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let lower = digits.get(..2).map(str::to_ascii_lowercase);
    let prefix = match lower.as_deref() {
        Some("0x") => Some(16),
        Some("0o") => Some(8),
        Some("0b") => Some(2),
        _ => None,
    };
    let (radix, digits, prefixed) = match (base, prefix) {
        (0, Some(radix)) => (radix, &digits[2..], true),
        (0, None) => (10, digits, false),
        (base, Some(radix)) if base == radix => (base, &digits[2..], true),
        (base, _) => (base, digits, false),
    };
    let body = if prefixed {
        digits.strip_prefix('_').unwrap_or(digits)
    } else {
        digits
    };
    let mut value: i128 = 0;
    let mut was_digit = false;
    for c in body.chars() {
        if c == '_' {
            if !was_digit {
                return None;
            }
            was_digit = false;
            continue;
        }
        let digit = c.to_digit(radix)?;
        value = value
            .saturating_mul(i128::from(radix))
            .saturating_add(i128::from(digit));
        was_digit = true;
    }
    let padded = base == 0 && !prefixed && body.starts_with('0') && value != 0;
    if !was_digit || padded {
        return None;
    }
    Some(if negative { -value } else { value })
}

/// `float(text)`
pub(crate) fn float(text: &str) -> Option<f64> {
    let text = strip(text);
    let digit = |at: usize| text.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
    let mut plain = String::with_capacity(text.len());
    for (at, c) in text.char_indices() {
        match c {
            '_' if at > 0 && digit(at - 1) && digit(at + 1) => {}
            '_' => return None,
            c => plain.push(c),
        }
    }
    plain.parse().ok()
}

/// `bytes.fromhex(text)`
pub(crate) fn from_hex(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, more @ ..] = rest {
        if first.is_ascii_whitespace() || *first == 0x0B {
            rest = more;
            continue;
        }
        let [high, low, more @ ..] = rest else {
            return None;
        };
        let digit = |byte: u8| char::from(byte).to_digit(16);
        bytes.push((digit(*high)? * 16 + digit(*low)?) as u8);
        rest = more;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_python_reads_them() {
        for (text, base, expected) in [
            ("0x10", 0, Some(16)),
            (" -0X1f ", 0, Some(-31)),
            ("0b11", 0, Some(3)),
            ("0o17", 0, Some(15)),
            ("1_000", 0, Some(1000)),
            ("0x_1", 0, Some(1)),
            ("00", 0, Some(0)),
            ("010", 0, None),
            ("010", 10, Some(10)),
            ("0x1", 10, None),
            ("", 0, None),
            ("+", 0, None),
            ("1__0", 0, None),
            ("1_", 0, None),
            ("0b1", 2, Some(1)),
            ("2", 2, None),
            ("FFFF", 16, Some(0xFFFF)),
            ("0x", 0, None),
            ("1 # one", 0, None),
        ] {
            assert_eq!(int(text, base), expected, "{text} {base}");
        }
        assert_eq!(float("1_0.5e1"), Some(105.0));
        assert_eq!((float("1.0f"), float("")), (None, None));
        assert_eq!(from_hex("12 aB"), Some(alloc::vec![0x12, 0xAB]));
        assert_eq!((from_hex("1 2"), from_hex("0x12")), (None, None));
    }
}
