//! A value as written, before its type is known.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use crate::description::Value;
use od_model::{DataType, Kind};

/// A default or a limit as written in a spec table.
#[derive(Clone, PartialEq, Debug)]
pub enum Raw {
    /// `42`, `-1`, `0x1F`.
    Integer(i128),
    /// `1.5`.
    Real(f64),
    /// `true`, `false`.
    Bool(bool),
    /// `"text"`.
    Text(String),
    /// `b"\x01\x02"`.
    Bytes(Vec<u8>),
    /// `$NODEID + 0x180`.
    NodeId(u32),
}

impl Raw {
    /// The value in the type `data_type`; `None` if it is not valid for it.
    pub(super) fn value_for(&self, data_type: DataType) -> Option<Value> {
        match (data_type.kind(), self) {
            (Kind::Boolean, Raw::Bool(b)) => Some(Value::Unsigned(u64::from(*b))),
            (Kind::Boolean | Kind::Unsigned | Kind::Signed, Raw::Integer(i)) => {
                integer(*i, data_type)
            }
            (Kind::Unsigned, Raw::NodeId(offset)) => Some(Value::NodeId(*offset)),
            (Kind::Real, Raw::Real(r)) => Some(Value::Real(*r)),
            #[allow(clippy::cast_precision_loss)] // what a REAL holds of it
            (Kind::Real, Raw::Integer(i)) => Some(Value::Real(*i as f64)),
            (Kind::Text, Raw::Text(text)) => Some(Value::Text(text.clone())),
            (Kind::Bytes, Raw::Bytes(bytes)) => Some(Value::Bytes(bytes.clone())),
            _ => None,
        }
    }
}

/// The spelling in a macro call.
impl fmt::Display for Raw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(i) => write!(f, "{i}"),
            Self::Real(r) => write!(f, "{r:?}"),
            Self::Bool(b) => write!(f, "{b}"),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Bytes(bytes) => write!(f, "b\"{}\"", bytes.escape_ascii()),
            Self::NodeId(0) => f.write_str("$NODEID"),
            Self::NodeId(offset) => write!(f, "$NODEID + 0x{offset:X}"),
        }
    }
}

impl From<&Value> for Raw {
    fn from(value: &Value) -> Self {
        match value {
            Value::Unsigned(v) => Self::Integer(i128::from(*v)),
            Value::Signed(v) => Self::Integer(i128::from(*v)),
            Value::Real(v) => Self::Real(*v),
            Value::NodeId(v) => Self::NodeId(*v),
            Value::Text(v) => Self::Text(v.clone()),
            Value::Bytes(v) => Self::Bytes(v.clone()),
        }
    }
}

fn integer(i: i128, data_type: DataType) -> Option<Value> {
    let (low, high) = data_type.integer_range()?;
    // It is in the range of the type, at most 64 bits with its sign, so neither cast changes it.
    (low..=high).contains(&i).then(|| match data_type.kind() {
        Kind::Signed => Value::Signed(i as i64),
        _ => Value::Unsigned(i as u64),
    })
}
