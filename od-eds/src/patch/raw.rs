//! A value as it is written, before it is known of which type it is.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::is_record;
use crate::description::Value;
use od_model::{DataType, Kind};

/// A default or a limit as a spec table writes it.
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

/// Why a value is not one of its type.
pub(super) struct Unfit {
    pub(super) message: String,
    pub(super) help: String,
}

impl Raw {
    /// The value as one of `data_type`.
    pub(super) fn value_for(&self, data_type: DataType) -> Result<Value, Unfit> {
        if is_record(data_type) {
            return Err(Unfit {
                message: format!("{data_type} is a record and has no value of its own"),
                help: "a member has one of the basic types".into(),
            });
        }
        match (data_type.kind(), self) {
            (Kind::Boolean, Raw::Bool(b)) => Ok(Value::Unsigned(u64::from(*b))),
            (Kind::Boolean | Kind::Unsigned | Kind::Signed, Raw::Integer(i)) => {
                integer(*i, data_type)
            }
            (Kind::Unsigned, Raw::NodeId(offset)) => Ok(Value::NodeId(*offset)),
            (Kind::Real, Raw::Real(r)) => Ok(Value::Real(*r)),
            #[allow(clippy::cast_precision_loss)] // what a REAL holds of it
            (Kind::Real, Raw::Integer(i)) => Ok(Value::Real(*i as f64)),
            (Kind::Text, Raw::Text(text)) => Ok(Value::Text(text.clone())),
            (Kind::Bytes, Raw::Bytes(bytes)) => Ok(Value::Bytes(bytes.clone())),
            (kind, raw) => Err(Unfit {
                message: format!("{} is not a value of {data_type}", raw.what()),
                help: format!("write {}", form(kind)),
            }),
        }
    }

    fn what(&self) -> String {
        match self {
            Self::Integer(i) => format!("the integer {i}"),
            Self::Real(r) => format!("the real number {r}"),
            Self::Bool(b) => format!("`{b}`"),
            Self::Text(text) => format!("the text {text:?}"),
            Self::Bytes(_) => "a byte string".into(),
            Self::NodeId(_) => "`$NODEID`".into(),
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

fn integer(i: i128, data_type: DataType) -> Result<Value, Unfit> {
    let (low, high) = data_type.integer_range().unwrap_or((0, 0));
    if i < low || i > high {
        return Err(Unfit {
            message: format!("{i} does not fit {data_type}"),
            help: format!("{data_type} holds {low} to {high}"),
        });
    }
    // In range of the type: at most 64 bits with its sign, so neither cast cuts.
    Ok(match data_type.kind() {
        Kind::Signed => Value::Signed(i as i64),
        _ => Value::Unsigned(i as u64),
    })
}

fn form(kind: Kind) -> &'static str {
    match kind {
        Kind::Boolean => "`true` or `false`",
        Kind::Unsigned => "a number, or `$NODEID + 0x180`",
        Kind::Signed => "a number",
        Kind::Real => "a number such as `1.5`",
        Kind::Text => "a text: `\"…\"`",
        Kind::Bytes => "a byte string: `b\"…\"`",
        Kind::Record => "the value at a member",
    }
}
