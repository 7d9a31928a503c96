//! Reads and writes values by their type.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::description::Value;
use crate::scan::number;
use crate::scan::number::{Note, Number};
use od_model::{DataType, Kind};

/// Reads a value of a type; `None` if it is invalid.
///
/// A number that does not fit the type is returned, too, so that the checks can report it:
/// as [`Value::Signed`] if it is negative, otherwise as the kind of the type if possible.
pub(crate) fn value(text: &str, data_type: DataType, notes: &mut Vec<Note>) -> Option<Value> {
    match data_type.kind() {
        Kind::Record => None,
        Kind::Text => Some(Value::Text(text.to_string())),
        Kind::Bytes if data_type == DataType::UnicodeString => {
            let units = text.encode_utf16().flat_map(u16::to_le_bytes);
            Some(Value::Bytes(units.collect()))
        }
        Kind::Bytes => Some(Value::Bytes(bytes(text, notes))),
        Kind::Real => {
            let text = number::without_comment(text, notes);
            let point = text.replace(',', ".");
            if point != text {
                notes.push(Note::Comma);
            }
            real(&point, data_type)
        }
        Kind::Boolean | Kind::Unsigned | Kind::Signed => {
            let text = number::without_comment(text, notes);
            if let Some(offset) = number::node_id(text, notes) {
                return offset.ok().map(Value::NodeId);
            }
            if data_type == DataType::Boolean
                && let Some(value) = word(text)
            {
                notes.push(Note::Word);
                return Some(value);
            }
            if let Some(time) = time(text, data_type) {
                return Some(time);
            }
            integer(number::integer(text, notes)?, data_type, notes)
        }
    }
}

fn word(text: &str) -> Option<Value> {
    [("false", 0), ("true", 1)]
        .iter()
        .find(|(word, _)| text.eq_ignore_ascii_case(word))
        .map(|(_, value)| Value::Unsigned(*value))
}

/// A time as days and milliseconds, in the spelling of Lely.
fn time(text: &str, data_type: DataType) -> Option<Value> {
    if !matches!(data_type, DataType::TimeOfDay | DataType::TimeDifference) {
        return None;
    }
    let (days, milliseconds) = text.split_once(char::is_whitespace)?;
    let days: u16 = days.parse().ok()?;
    let milliseconds: u32 = milliseconds.trim().parse().ok()?;
    Some(Value::Unsigned(
        u64::from(milliseconds) | u64::from(days) << 32,
    ))
}

fn integer(number: Number, data_type: DataType, notes: &mut Vec<Note>) -> Option<Value> {
    let Number { value, pattern } = number;
    if data_type.kind() == Kind::Signed
        && pattern
        && let Some(negative) = twos_complement(value, data_type)
    {
        notes.push(Note::TwosComplement);
        return Some(Value::Signed(negative));
    }
    if value < 0 {
        return i64::try_from(value).ok().map(Value::Signed);
    }
    if data_type.kind() == Kind::Signed
        && let Ok(value) = i64::try_from(value)
    {
        return Some(Value::Signed(value));
    }
    u64::try_from(value).ok().map(Value::Unsigned)
}

/// A number as written, even for a signed type.
pub(crate) fn pattern(text: &str) -> Option<Value> {
    let text = number::without_comment(text, &mut Vec::new());
    let number = number::integer(text, &mut Vec::new())?.value;
    match i64::try_from(number) {
        Ok(number) => Some(Value::Signed(number)),
        Err(_) => u64::try_from(number).ok().map(Value::Unsigned),
    }
}

/// The negative number of a bit pattern that is as wide as the type or was
/// sign-extended to 32 or 64 bits.
fn twos_complement(pattern: i128, data_type: DataType) -> Option<i64> {
    let (low, high) = data_type.integer_range()?;
    if pattern <= high {
        return None;
    }
    let bits = u32::from(data_type.bits()?);
    [bits, 32, 64]
        .into_iter()
        .filter(|width| *width >= bits)
        .map(|width| pattern - (1i128 << width))
        .find(|value| (low..0).contains(value))
        .and_then(|value| i64::try_from(value).ok())
}

/// A decimal number, or the bit pattern in hexadecimal.
fn real(text: &str, data_type: DataType) -> Option<Value> {
    if let Some(digits) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        if digits.starts_with('+') {
            return None;
        }
        let real = match data_type {
            DataType::Real32 => f64::from(f32::from_bits(u32::from_str_radix(digits, 16).ok()?)),
            _ => f64::from_bits(u64::from_str_radix(digits, 16).ok()?),
        };
        return real.is_finite().then_some(Value::Real(real));
    }
    // Rust's parser accepts the words `inf` and `nan`; C's suffix `f` is accepted without a finding.
    let digits = text.strip_suffix(['f', 'F']).unwrap_or(text);
    if !digits
        .bytes()
        .all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b))
    {
        return None;
    }
    let real: f64 = digits.parse().ok()?;
    real.is_finite().then_some(Value::Real(real))
}

/// Hexadecimal bytes: `0x1234AB`, `1234AB`, `12 34 AB`, `0x12 0x34`; otherwise the characters.
fn bytes(text: &str, notes: &mut Vec<Note>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for word in text.split_whitespace() {
        let digits = word
            .strip_prefix("0x")
            .or_else(|| word.strip_prefix("0X"))
            .unwrap_or(word);
        let nibble = |b: u8| char::from(b).to_digit(16).map(|d| d as u8);
        let ok = match digits.as_bytes() {
            [one] => nibble(*one).map(|value| bytes.push(value)).is_some(),
            [] => false,
            many if many.len() % 2 == 0 => {
                many.chunks(2)
                    .all(|pair| match (nibble(pair[0]), nibble(pair[1])) {
                        (Some(high), Some(low)) => {
                            bytes.push(high << 4 | low);
                            true
                        }
                        _ => false,
                    })
            }
            _ => false,
        };
        if !ok {
            notes.push(Note::Characters);
            return text.as_bytes().to_vec();
        }
    }
    bytes
}

/// The canonical text of a value of a type; see [`value`].
pub(crate) fn text(value: &Value, data_type: Option<DataType>) -> String {
    use alloc::format;
    match value {
        // For a signed type, hexadecimal is a bit pattern.
        Value::Unsigned(v) if data_type.is_some_and(|t| t.kind() == Kind::Signed) => v.to_string(),
        Value::Unsigned(v) => match data_type.and_then(DataType::bits) {
            Some(0..=16) => v.to_string(),
            _ => format!("0x{v:X}"),
        },
        Value::Signed(v) => v.to_string(),
        // A spelling that every reader takes for zero.
        Value::Real(0.0) => "0".into(),
        Value::Real(v) => format!("{v:?}"),
        Value::NodeId(offset) => format!("$NODEID+0x{offset:X}"),
        Value::Text(text) => text.clone(),
        Value::Bytes(bytes) if data_type == Some(DataType::UnicodeString) => {
            let units = bytes
                .chunks(2)
                .map(|pair| u16::from_le_bytes([pair[0], pair.get(1).copied().unwrap_or(0)]));
            char::decode_utf16(units)
                .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
                .collect()
        }
        Value::Bytes(bytes) => bytes.iter().map(|b| format!("{b:02X}")).collect(),
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[track_caller]
    fn check(written: &str, data_type: DataType, expected: Value, odd: &[Note]) {
        let mut notes = vec![];
        let read = value(written, data_type, &mut notes);
        assert_eq!(read, Some(expected.clone()), "{written}");
        assert_eq!(notes, odd, "{written}");
        let canonical = text(&expected, Some(data_type));
        notes.clear();
        let again = value(&canonical, data_type, &mut notes);
        assert_eq!(again, Some(expected), "{canonical}");
        assert_eq!(notes, [], "{canonical}");
    }

    #[test]
    fn integers_by_their_type() {
        use DataType::*;
        check("0xFF", Unsigned8, Value::Unsigned(255), &[]);
        check("0xFF", Integer8, Value::Signed(-1), &[Note::TwosComplement]);
        check("0x7F", Integer8, Value::Signed(127), &[]);
        check(
            "0xFFFF8000",
            Integer16,
            Value::Signed(-32768),
            &[Note::TwosComplement],
        );
        check(
            "0x800000",
            Integer24,
            Value::Signed(-0x80_0000),
            &[Note::TwosComplement],
        );
        check(
            "0xFFFFFFFFFFFFFFFF",
            Integer64,
            Value::Signed(-1),
            &[Note::TwosComplement],
        );
        check("-0x80", Integer8, Value::Signed(-128), &[]);
        check(
            "0xFFFFFFFFFFFFFFFF",
            Unsigned64,
            Value::Unsigned(u64::MAX),
            &[],
        );
        check("$NODEID+0x600", Unsigned32, Value::NodeId(0x600), &[]);
        check("TRUE", Boolean, Value::Unsigned(1), &[Note::Word]);
        check(
            "365 43200000",
            TimeOfDay,
            Value::Unsigned(365 << 32 | 43_200_000),
            &[],
        );
    }

    #[test]
    fn a_number_that_does_not_fit_is_still_a_value() {
        use DataType::*;
        check("300", Unsigned8, Value::Unsigned(300), &[]);
        check("-1", Unsigned8, Value::Signed(-1), &[]);
        check("65535", Integer16, Value::Signed(65535), &[]);
        check(
            "18446744073709551615",
            Integer64,
            Value::Unsigned(u64::MAX),
            &[],
        );
        let mut notes = vec![];
        for bad in ["red", "", "1,5", "0.5", "$NODEID-1", "nan"] {
            assert_eq!(value(bad, Unsigned8, &mut notes), None, "{bad}");
        }
        for bad in ["red", "", "nan", "inf", "1e999", "0x7FC00000"] {
            assert_eq!(value(bad, Real32, &mut notes), None, "{bad}");
        }
    }

    #[test]
    fn reals() {
        use DataType::*;
        check("1.5", Real32, Value::Real(1.5), &[]);
        check("-3.4E+38", Real32, Value::Real(-3.4e38), &[]);
        check("2", Real64, Value::Real(2.0), &[]);
        check(
            "0x40490FDB",
            Real32,
            Value::Real(f64::from(core::f32::consts::PI)),
            &[],
        );
        check("1.0f", Real32, Value::Real(1.0), &[]);
        check("-1,5", Real64, Value::Real(-1.5), &[Note::Comma]);
        assert_eq!(value("1,000.5", Real64, &mut vec![]), None);
    }

    #[test]
    fn strings_and_bytes() {
        use DataType::*;
        check("a ; b", VisibleString, Value::Text("a ; b".into()), &[]);
        check("$NODEID", VisibleString, Value::Text("$NODEID".into()), &[]);
        let abc = Value::Bytes(vec![0x12, 0x34, 0xAB]);
        for text in ["1234AB", "0x1234ab", "12 34 AB", "0x12 0x34 0xAB"] {
            check(text, OctetString, abc.clone(), &[]);
        }
        check("1 2", Domain, Value::Bytes(vec![1, 2]), &[]);
        check(
            "@A",
            Domain,
            Value::Bytes(b"@A".to_vec()),
            &[Note::Characters],
        );
        check(
            "aµ",
            UnicodeString,
            Value::Bytes(vec![0x61, 0, 0xB5, 0]),
            &[],
        );
    }
}
