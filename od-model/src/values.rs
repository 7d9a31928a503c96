//! Values and addresses in the form that users write and read.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::address::Address;
use crate::dictionary::Dictionary;
use crate::entry::{Entry, Missing};
use crate::refused::Refused;
use crate::typed::Scalar;
use crate::types::{DataType, Kind};

/// A value as text, by its type: `497042 (79592h)`, `-5`, `"GXMM"`, `01 02 03`.
pub fn show(data_type: DataType, bytes: &[u8]) -> String {
    if data_type.size().is_some_and(|size| size != bytes.len()) {
        return hex(bytes);
    }
    match data_type.kind() {
        Kind::Boolean => String::from(if bytes == [0] { "false" } else { "true" }),
        Kind::Unsigned => match u64::from_wire(bytes) {
            small @ 0..=9 => small.to_string(),
            value => format!("{value} ({value:X}h)"),
        },
        Kind::Signed => i64::from_wire(bytes).to_string(),
        Kind::Real => match *bytes {
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]).to_string(),
            _ => f64::from_bits(u64::from_wire(bytes)).to_string(),
        },
        Kind::Text => format!("{:?}", String::from_utf8_lossy(bytes)),
        Kind::Bytes | Kind::Record => hex(bytes),
    }
}

/// The first `bits` bits of a value, which a PDO may map; a signed number keeps its sign.
pub fn show_bits(data_type: DataType, bytes: &[u8], bits: u8) -> String {
    let is_number = matches!(data_type.kind(), Kind::Unsigned | Kind::Signed);
    let Some(size) = data_type
        .size()
        .filter(|size| is_number && (1..8 * *size).contains(&usize::from(bits)))
    else {
        return show(data_type, bytes);
    };
    let mut wide = [0; 8];
    let len = bytes.len().min(8);
    wide[..len].copy_from_slice(&bytes[..len]);
    let unused = 64 - u32::from(bits);
    let raw = u64::from_le_bytes(wide) << unused;
    let value = if data_type.kind() == Kind::Signed {
        (raw as i64 >> unused) as u64
    } else {
        raw >> unused
    };
    show(data_type, &value.to_le_bytes()[..size.min(8)])
}

/// Two hexadecimal digits per byte, separated by blanks: `43 02 60 00`.
pub fn hex(bytes: &[u8]) -> String {
    bytes
        .iter()
        .map(|byte| format!("{byte:02X}"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// The bytes of a value that a user typed: `4096`, `0x1000`, `1000h`, `-5`, `1.5`, `true`,
/// `"text"`, or `[01 02 03]` for bytes of any type.
///
/// # Errors
/// A message that names the valid values.
pub fn parse(data_type: DataType, text: &str) -> Result<Vec<u8>, Refused> {
    let text = text.trim();
    if let Some(inner) = text
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'))
    {
        let wrong = || format!("`{text}` is not a list of hex bytes").into();
        return parse_hex(inner).ok_or_else(wrong);
    }
    let quoted = text
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    match (data_type.kind(), quoted) {
        (Kind::Text | Kind::Bytes, Some(inner)) => return Ok(inner.as_bytes().to_vec()),
        (Kind::Text | Kind::Bytes | Kind::Record, _) => {
            return Err(format!("{data_type} is written as \"text\" or as [01 02 03]").into());
        }
        (_, Some(inner)) if data_type.size() == Some(inner.len()) => {
            return Ok(inner.as_bytes().to_vec());
        }
        (_, Some(_)) => return Err(format!("a text is not {data_type}").into()),
        _ => {}
    }
    if data_type.kind() == Kind::Real {
        let value: f64 = text
            .parse()
            .map_err(|_| format!("`{text}` is not a number"))?;
        return Ok(match data_type.size() {
            Some(4) => (value as f32).to_le_bytes().to_vec(),
            _ => value.to_le_bytes().to_vec(),
        });
    }
    let value = match text {
        "true" => 1,
        "false" => 0,
        _ => integer(text)
            .or_else(|| with_base(text))
            .ok_or_else(|| not_a_number(text, data_type))?,
    };
    let (low, high) = data_type.integer_range().unwrap_or((0, 0));
    if value < low || value > high {
        return Err(format!("{data_type} goes from {low} to {high}").into());
    }
    let size = data_type.size().unwrap_or(0).min(16);
    Ok(value.to_le_bytes()[..size].to_vec())
}

/// Reads a number as a PLC writes it (IEC 61131-3): `16#3E8`, `2#101`; or `0b101`, `$3E8`.
fn with_base(text: &str) -> Option<i128> {
    let (radix, digits) = [("16#", 16), ("$", 16), ("2#", 2), ("0b", 2)]
        .into_iter()
        .find_map(|(start, radix)| Some((radix, text.strip_prefix(start)?)))?;
    let digits = digits.replace('_', "");
    let is_number = digits.chars().all(|digit| digit.is_digit(radix));
    let value = u64::from_str_radix(&digits, radix).ok();
    value.filter(|_| is_number).map(i128::from)
}

/// Says what to write for a text of the length of the value, such as the signature `save` of 1010h.
fn not_a_number(text: &str, data_type: DataType) -> String {
    let is_word = text.bytes().all(|byte| byte.is_ascii_alphabetic());
    if is_word && data_type.size() == Some(text.len()) {
        format!("`{text}` is not a number; write the text as `\"{text}\"`")
    } else {
        format!("`{text}` is not a number")
    }
}

/// Reads a decimal or hexadecimal number (`0x…`, `…h`) with an optional minus and underscores between digits.
pub fn integer(text: &str) -> Option<i128> {
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => (-1, rest),
        None => (1, text),
    };
    let digits = text.replace('_', "");
    let hex = digits
        .strip_prefix("0x")
        .or_else(|| digits.strip_prefix("0X"));
    let hex = hex.or_else(|| digits.strip_suffix(['h', 'H']));
    let value = match hex {
        Some(hex) => u64::from_str_radix(hex, 16).ok()?,
        None => digits.parse::<u64>().ok()?,
    };
    Some(sign * i128::from(value))
}

fn parse_hex(text: &str) -> Option<Vec<u8>> {
    let byte = |word: &str| {
        u8::from_str_radix(word, 16)
            .ok()
            .filter(|_| word.len() == 2)
    };
    text.split_whitespace().map(byte).collect()
}

/// Reads an address as users write it: `6004h`, `1018h:02`, `0x1018:2`, `1018sub2`, `0x1018,2`, `1018/2`, `16#1018:2`. The
/// sub-index is hexadecimal, and 0 if missing.
pub fn address(text: &str) -> Option<Address> {
    let text = text.trim();
    let (index, sub) = match text.split_once([':', ',', '/']) {
        Some((index, sub)) => (index, Some(sub)),
        None => match text.find("sub") {
            Some(at) => (&text[..at], Some(&text[at + 3..])),
            None => (text, None),
        },
    };
    let hex = |text: &str| {
        let text = text.trim();
        let digits = ["0x", "0X", "16#"]
            .into_iter()
            .find_map(|start| text.strip_prefix(start))
            .unwrap_or(text);
        let digits = digits.strip_suffix(['h', 'H']).unwrap_or(digits);
        u32::from_str_radix(digits, 16)
            .ok()
            .filter(|_| digits.len() <= 4)
    };
    let index = u16::try_from(hex(index)?).ok()?;
    let sub = u8::try_from(sub.map_or(Some(0), hex)?).ok()?;
    Some(Address::new(index, sub))
}

/// Finds an entry by [`address`], or by its name in any case. A sub-object is found by its own name
/// if no other has this name, or by `object.member`.
///
/// # Errors
/// A message that says why no entry matches.
pub fn find(dictionary: Dictionary<'_>, text: &str) -> Result<Entry, Refused> {
    let text = text.trim();
    if let Some(address) = address(text) {
        return dictionary.find(address).map_err(|missing| match missing {
            Missing::Object => format!("object {:04X}h does not exist", address.index).into(),
            Missing::SubIndex => format!("sub-index {address} does not exist").into(),
        });
    }
    let wanted = text.trim_matches('"');
    let mut found = dictionary.entries().filter(|entry| {
        name(dictionary, entry).eq_ignore_ascii_case(wanted)
            || dictionary.text(entry.name).eq_ignore_ascii_case(wanted)
    });
    match (found.next(), found.next()) {
        (Some(entry), None) => Ok(entry),
        (Some(first), Some(second)) => Err(format!(
            "`{wanted}` is the name of {} and of {}; write the address",
            first.address, second.address
        )
        .into()),
        (None, _) => {
            // `1018.1` and `1018 1` are ways of other tools.
            let meant = address(&wanted.replacen(['.', ' '], ":", 1));
            let help = meant.map_or(String::new(), |meant| format!("; write `{meant}`"));
            Err(format!("no object is called `{wanted}`{help}").into())
        }
    }
}

/// The full name of an entry: the name of the object, followed by a dot and the name of the
/// sub-object.
pub fn name(dictionary: Dictionary<'_>, entry: &Entry) -> String {
    let own = dictionary.text(entry.name);
    match dictionary.object(entry.address.index) {
        Some(object) if object.code.has_members() => {
            format!("{}.{own}", dictionary.text(object.name))
        }
        _ => own.to_owned(),
    }
}

/// An address with its name, if the dictionary has one: `6004h Position value`.
pub fn label(dictionary: Dictionary<'_>, address: Address) -> String {
    let number = match (address.sub, dictionary.object(address.index)) {
        (0, Some(object)) if !object.code.has_members() => format!("{:04X}h", address.index),
        _ => address.to_string(),
    };
    match dictionary.find(address) {
        Ok(entry) => format!("{number} {}", name(dictionary, &entry)),
        Err(_) => number,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shown_values_can_be_parsed() {
        for (data_type, text, bytes) in [
            (DataType::Unsigned32, "497042", &[0x92, 0x95, 7, 0][..]),
            (DataType::Unsigned32, "0x79592", &[0x92, 0x95, 7, 0]),
            (DataType::Unsigned32, "79592h", &[0x92, 0x95, 7, 0]),
            (DataType::Unsigned32, "\"save\"", b"save"),
            (DataType::Integer16, "-5", &[0xFB, 0xFF]),
            (DataType::Boolean, "true", &[1]),
            (DataType::VisibleString, "\"GXMM\"", b"GXMM"),
            (DataType::Domain, "[01 02]", &[1, 2]),
            (DataType::Real32, "1.5", &[0, 0, 0xC0, 0x3F]),
        ] {
            assert_eq!(parse(data_type, text).as_deref(), Ok(bytes), "{text}");
        }
        assert_eq!(
            show(DataType::Unsigned32, &[0x92, 0x95, 7, 0]),
            "497042 (79592h)"
        );
        assert_eq!(show(DataType::Integer16, &[0xFB, 0xFF]), "-5");
        assert_eq!(show(DataType::Unsigned32, &[1, 2]), "01 02");
        assert_eq!(show_bits(DataType::Integer16, &[0xD1, 0x1B], 13), "-1071");
        assert_eq!(show_bits(DataType::Integer16, &[0xD1, 0x0B], 13), "3025");
        assert_eq!(
            show_bits(DataType::Unsigned16, &[0xD1, 0x1B], 13),
            "7121 (1BD1h)"
        );
        assert_eq!(show_bits(DataType::Unsigned8, &[5], 8), "5");
        for text in ["1000", "16#3E8", "$3e8", "2#11_1110_1000", "0b1111101000"] {
            assert_eq!(
                parse(DataType::Unsigned16, text).as_deref(),
                Ok(&[0xE8, 3][..]),
                "{text}"
            );
        }
        for text in ["16#", "16#-1", "2#2", "$", "#1"] {
            assert!(parse(DataType::Unsigned16, text).is_err(), "{text}");
        }
        let save = parse(DataType::Unsigned32, "save").map_err(|why| why.to_string());
        assert_eq!(
            save,
            Err("`save` is not a number; write the text as `\"save\"`".into())
        );
        assert!(parse(DataType::Unsigned8, "256").is_err());
        assert!(parse(DataType::Unsigned8, "").is_err());
    }

    #[test]
    fn addresses_are_written_in_many_ways() {
        for text in [
            "1018h:02",
            "1018:2",
            "0x1018:02h",
            "1018sub2",
            " 1018h:2 ",
            "0x1018,2",
            "0X1018, 0x02",
            "1018/2",
            "16#1018:16#2",
        ] {
            assert_eq!(address(text), Some(Address::new(0x1018, 2)), "{text}");
        }
        assert_eq!(address("6004h"), Some(Address::new(0x6004, 0)));
        for text in ["", "h", "10180", "1018:100", "x", "ä:1", "1018:"] {
            assert_eq!(address(text), None, "{text}");
        }
    }
}
