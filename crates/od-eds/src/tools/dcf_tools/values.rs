//! Types, numbers and formulas as in dcf-tools.

use crate::tools::python::int;
use crate::tools::shared::NODE_ID;
use crate::tools::tool::Read;

/// `$NODEID+` and a number: whether it has the node ID, and the number's text.
pub(super) fn parts(text: &str) -> Option<(bool, &str)> {
    let after = text
        .get(..7)
        .filter(|word| word.eq_ignore_ascii_case("$NODEID"))
        .map(|_| text[7..].trim_start());
    let after = after
        .and_then(|rest| rest.strip_prefix('+'))
        .map(str::trim_start);
    let number = after.unwrap_or(text);
    let digits = number.strip_prefix('-').unwrap_or(number);
    let hex = digits
        .get(..2)
        .filter(|sign| sign.eq_ignore_ascii_case("0x"))
        .map(|_| &digits[2..]);
    let fits = match hex {
        Some(hex) => !hex.is_empty() && hex.bytes().all(|byte| byte.is_ascii_hexdigit()),
        None => !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()),
    };
    fits.then_some((after.is_some(), number))
}

/// The number of a text, and whether the node ID is added to it.
pub(super) fn formula(text: &str) -> Option<(bool, i128)> {
    if text.eq_ignore_ascii_case("$NODEID") {
        return Some((true, 0));
    }
    let (has_node_id, number) = parts(text)?;
    Some((has_node_id, int(number, 0)?))
}

/// The real whose bits a text has.
pub(super) fn real(text: &str, data_type: i128) -> Option<f64> {
    let bits = int(text, 0)?;
    match data_type {
        8 => u32::try_from(bits)
            .ok()
            .map(|bits| f64::from(f32::from_bits(bits))),
        _ => u64::try_from(bits).ok().map(f64::from_bits),
    }
}

/// Reads a value of a basic type as the tool does.
pub(super) fn value(text: &str, data_type: i128) -> Option<Read> {
    if is_real(data_type) {
        return real(text, data_type).map(Read::Real);
    }
    limits(data_type)?;
    let (has_node_id, number) = formula(text)?;
    Some(Read::Number(number + if has_node_id { NODE_ID } else { 0 }))
}

pub(super) fn is_real(data_type: i128) -> bool {
    matches!(data_type, 0x8 | 0x11)
}

/// The numbers of a basic type; those of a real are not used.
pub(super) fn limits(data_type: i128) -> Option<(i128, i128)> {
    let (bits, signed) = match data_type {
        0x1 => (1, false),
        0x2 => (8, true),
        0x3 => (16, true),
        0x4 => (32, true),
        0x5 => (8, false),
        0x6 => (16, false),
        0x7 | 0x8 => (32, false),
        0x10 => (24, true),
        0x12 => (40, true),
        0x13 => (48, true),
        0x14 => (56, true),
        0x15 => (64, true),
        0x16 => (24, false),
        0x18 => (40, false),
        0x19 => (48, false),
        0x1A => (56, false),
        0x1B | 0x11 => (64, false),
        _ => return None,
    };
    Some(if signed {
        (-(1i128 << (bits - 1)), (1i128 << (bits - 1)) - 1)
    } else {
        (0, (1i128 << bits) - 1)
    })
}
