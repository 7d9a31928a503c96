//! JavaScript's numbers, and how the package stores values.

use alloc::string::String;
use alloc::vec::Vec;

use crate::tools::tool::Read;

pub(super) fn is_space(c: char) -> bool {
    c == '\u{FEFF}' || c != '\u{85}' && c.is_whitespace()
}

pub(super) fn trim(text: &str) -> &str {
    text.trim_matches(is_space)
}

/// A value: a text, or the value of `true`, `false`, `null` and of a key without `=`.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Given {
    Text(String),
    Flag(bool),
    Null,
}

/// `parseInt(text)`; `None` for NaN.
pub(super) fn parse_int(text: &str) -> Option<f64> {
    let text = trim(text);
    let (sign, digits) = match text.as_bytes().first()? {
        b'-' => (-1.0, &text[1..]),
        b'+' => (1.0, &text[1..]),
        _ => (1.0, text),
    };
    let hex = digits
        .strip_prefix("0x")
        .or_else(|| digits.strip_prefix("0X"));
    let (radix, digits) = hex.map_or((10, digits), |digits| (16, digits));
    let digits: Vec<u32> = digits.chars().map_while(|c| c.to_digit(radix)).collect();
    if digits.is_empty() {
        return None;
    }
    let add = |sum: f64, digit: &u32| sum * f64::from(radix) + f64::from(*digit);
    Some(sign * digits.iter().fold(0.0, add))
}

/// `Number(text)`; NaN for a text that is not a number.
pub(super) fn number(text: &str) -> f64 {
    let text = trim(text);
    let lower = text.get(..2).map(str::to_ascii_lowercase);
    let radix = match lower.as_deref() {
        Some("0x") => 16,
        Some("0o") => 8,
        Some("0b") => 2,
        _ => 10,
    };
    if radix != 10 {
        let digits: Option<Vec<u32>> = text[2..].chars().map(|c| c.to_digit(radix)).collect();
        let digits = digits.filter(|digits| !digits.is_empty());
        let add = |sum: f64, digit: &u32| sum * f64::from(radix) + f64::from(*digit);
        return digits.map_or(f64::NAN, |digits| digits.iter().fold(0.0, add));
    }
    match text {
        "" => 0.0,
        "Infinity" | "+Infinity" => f64::INFINITY,
        "-Infinity" => f64::NEG_INFINITY,
        text if text.contains(['n', 'N', 'i', 'I']) => f64::NAN,
        text => text.parse().unwrap_or(f64::NAN),
    }
}

/// `BigInt(text)`
pub(super) fn big(text: &str) -> Option<i128> {
    let text = trim(text);
    let lower = text.get(..2).map(str::to_ascii_lowercase);
    let (radix, digits) = match lower.as_deref() {
        Some("0x") => (16, &text[2..]),
        Some("0o") => (8, &text[2..]),
        Some("0b") => (2, &text[2..]),
        _ => (10, text),
    };
    if text.is_empty() {
        return Some(0);
    }
    let signed = radix != 10 && digits.starts_with(['-', '+']);
    i128::from_str_radix(digits, radix).ok().filter(|_| !signed)
}

/// The bits and the sign of an integer type that it stores.
pub(super) fn integer(data_type: i128) -> Option<(u32, bool)> {
    Some(match data_type {
        0x2 => (8, true),
        0x3 => (16, true),
        0x4 => (32, true),
        0x10 => (24, true),
        0x12 => (40, true),
        0x13 => (48, true),
        0x14 | 0x15 => (64, true),
        0x5 => (8, false),
        0x6 => (16, false),
        0x7 => (32, false),
        0x16 => (24, false),
        0x18 => (40, false),
        0x19 => (48, false),
        0x1A | 0x1B => (64, false),
        _ => return None,
    })
}

/// The value that the tool stores for a default value; an error if it raises one, `None` if it stores nothing.
pub(super) fn raw(text: &Given, data_type: i128) -> Result<Option<Read>, ()> {
    let is_true = match text {
        Given::Text(text) => !text.is_empty(),
        Given::Flag(flag) => *flag,
        Given::Null => false,
    };
    let double = || match text {
        Given::Text(text) => number(text),
        Given::Flag(flag) => f64::from(u8::from(*flag)),
        Given::Null => 0.0,
    };
    if let Some((bits, signed)) = integer(data_type) {
        let (low, high) = if signed {
            (-(1i128 << (bits - 1)), (1i128 << (bits - 1)) - 1)
        } else {
            (0, (1i128 << bits) - 1)
        };
        let value = match text {
            Given::Text(text) if bits == 64 => big(text).ok_or(())?,
            _ => {
                let value = double();
                if value > high as f64 || value < low as f64 {
                    return Err(());
                }
                value as i128
            }
        };
        return if (low..=high).contains(&value) {
            Ok(Some(Read::Number(value)))
        } else {
            Err(())
        };
    }
    Ok(match (data_type, text) {
        (0x1, _) => Some(Read::Number(i128::from(is_true))),
        (0x8, _) => Some(Read::Real(f64::from(double() as f32))),
        (0x11, _) => Some(Read::Real(double())),
        (0x9..=0xB, Given::Flag(true)) => return Err(()),
        (0x9, Given::Text(text)) => {
            let end = text.find('\0').unwrap_or(text.len());
            Some(Read::Text(text[..end].into()))
        }
        (0xA, Given::Text(text)) => Some(Read::Bytes(text.as_bytes().into())),
        (0xB, Given::Text(text)) => Some(Read::Text(text.clone())),
        _ => None,
    })
}
