//! A value as a C variable: its type, its length, its initial value.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::tables::fitting;
use crate::description::{EntryDescription, Value};
use od_model::{DataType, Kind};

/// Length of a string that can change and has a shorter default; the same as in a node of odkit.
const STRING_CAPACITY: usize = 64;

/// A C variable.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Data {
    /// The type of the variable, or of its elements.
    pub(super) c_type: &'static str,
    /// Elements of the C array; `None` if it is a plain variable.
    pub(super) elements: Option<usize>,
    /// The initial value; `None` for a value without storage.
    pub(super) first: Option<String>,
    /// Bytes on the bus.
    pub(super) length: usize,
    /// Attributes of the type, such as ` | ODA_MB`.
    pub(super) attributes: &'static str,
}

impl Data {
    /// The array part of the declaration: `[65]`, or nothing.
    pub(super) fn array(&self) -> String {
        self.elements
            .map_or(String::new(), |count| format!("[{count}]"))
    }

    /// Path from a variable to its first element: `[0]`, or empty.
    pub(super) fn to_first(&self) -> &'static str {
        if self.elements.is_some() { "[0]" } else { "" }
    }
}

/// The variable of a value; `None` for records and unknown types.
///
/// A value of a known size without a default gets 0: CANopenNode answers a request for a
/// variable without storage with the abort code of a missing sub-index.
pub(super) fn data(entry: &EntryDescription, number: Option<i128>) -> Option<Data> {
    let data_type = entry.data_type?.value;
    let value = fitting(&entry.parameter, data_type).or(fitting(&entry.default, data_type));
    Some(match (data_type.kind(), data_type.bits()) {
        (Kind::Record, _) => return None,
        (Kind::Real, bits) => {
            let (c_type, length) = match bits {
                Some(32) => ("float32_t", 4),
                _ => ("float64_t", 8),
            };
            let real = match value {
                Some(Value::Real(real)) => *real,
                _ => 0.0,
            };
            plain(c_type, length, self::real(real))
        }
        (kind, Some(bits)) => self::number(kind, bits, number.unwrap_or(0)),
        (kind, None) => {
            let bytes: &[u8] = match value {
                Some(Value::Text(text)) => text.as_bytes(),
                Some(Value::Bytes(bytes)) => bytes,
                _ => &[],
            };
            text(entry, data_type, kind, bytes)
        }
    })
}

fn plain(c_type: &'static str, length: usize, first: String) -> Data {
    Data {
        c_type,
        elements: None,
        first: Some(first),
        length,
        attributes: if length > 1 { " | ODA_MB" } else { "" },
    }
}

fn number(kind: Kind, bits: u8, value: i128) -> Data {
    let c_type = match (kind, bits) {
        (Kind::Boolean, _) => {
            return plain(
                "bool_t",
                1,
                if value == 0 { "false" } else { "true" }.into(),
            );
        }
        (Kind::Signed, 8) => "int8_t",
        (Kind::Signed, 16) => "int16_t",
        (Kind::Signed, 32) => "int32_t",
        (Kind::Signed, 64) => "int64_t",
        (_, 8) => "uint8_t",
        (_, 16) => "uint16_t",
        (_, 32) => "uint32_t",
        (_, 64) => "uint64_t",
        // C has no integer of this size.
        _ => return bytes(&value.to_le_bytes()[..usize::from(bits) / 8]),
    };
    let length = usize::from(bits) / 8;
    let first = match kind {
        // C has no literal for the smallest number of 64 bits.
        Kind::Signed if value == i64::MIN.into() => "(-9223372036854775807 - 1)".into(),
        Kind::Signed => format!("{value}"),
        _ => format!("0x{value:0width$X}", width = 2 * length),
    };
    plain(c_type, length, first)
}

fn real(value: f64) -> String {
    match value {
        value if value.is_nan() => "(0.0 / 0.0)".into(),
        value if value.is_infinite() && value > 0.0 => "(1.0 / 0.0)".into(),
        value if value.is_infinite() => "(-1.0 / 0.0)".into(),
        value => format!("{value:?}"),
    }
}

/// A sequence of bytes that is not empty.
fn bytes(bytes: &[u8]) -> Data {
    let texts: Vec<String> = bytes.iter().map(|byte| format!("0x{byte:02X}")).collect();
    Data {
        c_type: "uint8_t",
        elements: Some(bytes.len()),
        first: Some(format!("{{{}}}", texts.join(", "))),
        length: bytes.len(),
        attributes: "",
    }
}

fn text(entry: &EntryDescription, data_type: DataType, kind: Kind, given: &[u8]) -> Data {
    let can_change = entry.access.writable() || given.is_empty();
    let room = entry.capacity.map_or(STRING_CAPACITY, usize::from);
    let length = if can_change {
        given.len().max(room)
    } else {
        given.len()
    };
    if kind == Kind::Text {
        let mut texts: Vec<String> = given.iter().copied().map(character).collect();
        // An additional character ends it.
        texts.resize(length + 1, "0".into());
        return Data {
            c_type: "char",
            elements: Some(length + 1),
            first: Some(format!("{{{}}}", texts.join(", "))),
            length,
            attributes: " | ODA_STR",
        };
    }
    if data_type == DataType::UnicodeString {
        let units = given.chunks(2);
        let units = units.map(|unit| u16::from_le_bytes([unit[0], *unit.get(1).unwrap_or(&0)]));
        let mut texts: Vec<String> = units.map(|unit| format!("0x{unit:04X}")).collect();
        let length = length.div_ceil(2);
        texts.resize(length + 1, "0x0000".into());
        return Data {
            c_type: "uint16_t",
            elements: Some(length + 1),
            first: Some(format!("{{{}}}", texts.join(", "))),
            length: 2 * length,
            // CANopenNode ends such a string at its first zero byte when a master reads it.
            attributes: if can_change { " | ODA_STR" } else { "" },
        };
    }
    match given {
        [] => Data {
            c_type: "",
            elements: None,
            first: None,
            length: 0,
            attributes: "",
        },
        given => bytes(given),
    }
}

fn character(byte: u8) -> String {
    match byte {
        b'\'' | b'\\' => format!("'\\{}'", char::from(byte)),
        b' '..=b'~' => format!("'{}'", char::from(byte)),
        0..=0x7F => format!("0x{byte:02X}"),
        _ => format!("(char)0x{byte:02X}"),
    }
}

/// The initial values of the elements of an array.
pub(super) fn list(values: &[&Data]) -> String {
    let values = values.iter().filter_map(|data| data.first.as_deref());
    format!("{{{}}}", values.collect::<Vec<_>>().join(", "))
}
