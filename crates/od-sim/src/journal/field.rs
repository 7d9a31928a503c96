//! Fields of an input in the form of an outside program, and the checks on them: they may come
//! from a link of unknown origin.

use std::prelude::v1::*;
use std::{fmt, format};

/// Limit of bytes of an input, and of steps of a profile.
const MOST_BYTES: usize = 150_000;
const MOST_STEPS: usize = 2000;
/// Limit of bytes of an EDS text or a lesson.
const LONGEST: usize = 8_000_000;
/// Range of numbers.
const LARGEST: f64 = 1e9;

/// A value of a field.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// The field is missing.
    Missing,
    /// No value.
    Null,
    /// A truth value.
    Flag(bool),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// Numbers.
    Numbers(Vec<f64>),
}

/// Reason why an input cannot be read, or a run not begin.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Error {
    /// A field is missing or has an invalid value.
    InvalidField,
    /// It was written by a later version.
    Newer,
    /// The run has too many devices.
    Devices,
    /// The run takes too much virtual time.
    Time,
    /// The run has too many frames that are sent periodically.
    Frames,
}

impl Error {
    /// A word for programs: `cut`, `newer`, `devices`, `time`, `frames`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InvalidField => "cut",
            Self::Newer => "newer",
            Self::Devices => "devices",
            Self::Time => "time",
            Self::Frames => "frames",
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::InvalidField => {
                "a field of the input is missing, or has a value that is not allowed"
            }
            Self::Newer => "a later version wrote the input",
            Self::Devices => "the run has too many devices",
            Self::Time => "the run takes too long",
            Self::Frames => "the run sends too many frames",
        })
    }
}

impl core::error::Error for Error {}

/// Source of the fields. A field of a field is named `source.name`.
pub trait Fields {
    /// Returns the value of a field.
    fn get(&self, key: &str) -> Value;
}

/// Receiver of the fields.
pub trait Sink {
    /// Stores the value of a field.
    fn put(&mut self, key: &str, value: Value);
}

/// Type of a field in TypeScript.
pub(super) trait Declared {
    /// `?` after the name of an optional field.
    const MARK: &'static str = "";
    /// The type.
    const TYPE: &'static str;
}

/// A field with fields of its own.
pub(super) trait Part {
    /// Reads it.
    fn read(&mut self, from: &dyn Fields, key: &str) -> Result<(), Error>;

    /// Writes it.
    fn write(&mut self, to: &mut dyn Sink, key: &str);
}

/// The fields of a field: outside, each is named `source.name`.
pub(super) struct Within<'a, T: ?Sized>(pub(super) &'a mut T, pub(super) &'a str);

impl Fields for Within<'_, &dyn Fields> {
    fn get(&self, key: &str) -> Value {
        self.0.get(&format!("{}.{key}", self.1))
    }
}

impl Sink for Within<'_, dyn Sink + '_> {
    fn put(&mut self, key: &str, value: Value) {
        self.0.put(&format!("{}.{key}", self.1), value);
    }
}

/// A field of an input that can be read and written.
pub(super) enum Field<'a> {
    Place(&'a mut u8),
    MaybePlace(&'a mut Option<u8>),
    Count(&'a mut u32),
    Number(&'a mut f64),
    Flag(&'a mut bool),
    Text(&'a mut String),
    Bytes(&'a mut Vec<u8>),
    Steps(&'a mut Vec<f64>),
    Part(&'a mut dyn Part),
}

macro_rules! fields {
    ($($kind:ty => $name:ident, $mark:literal $type:literal;)*) => {
        $(impl<'a> From<&'a mut $kind> for Field<'a> {
            fn from(field: &'a mut $kind) -> Self {
                Self::$name(field)
            }
        }

        impl Declared for $kind {
            const MARK: &'static str = $mark;
            const TYPE: &'static str = $type;
        })*
    };
}

fields! {
    u8 => Place, "" "number";
    Option<u8> => MaybePlace, "?" "number";
    u32 => Count, "" "number";
    f64 => Number, "" "number";
    bool => Flag, "" "boolean";
    String => Text, "" "string";
    Vec<u8> => Bytes, "" "Uint8Array";
    Vec<f64> => Steps, "" "number[]";
}

impl<'a, T: Part> From<&'a mut T> for Field<'a> {
    fn from(field: &'a mut T) -> Self {
        Self::Part(field)
    }
}

impl Field<'_> {
    /// Reads the field.
    pub(super) fn read(self, from: &dyn Fields, key: &str) -> Result<(), Error> {
        match (self, from.get(key)) {
            (Self::Part(to), _) => to.read(from, key)?,
            (Self::MaybePlace(to), Value::Missing) => *to = None,
            (Self::MaybePlace(to), value) => *to = Some(whole(&value, 255)? as u8),
            (Self::Place(to), value) => *to = whole(&value, 255)? as u8,
            (Self::Count(to), value) => *to = whole(&value, u32::MAX)?,
            (Self::Number(to), Value::Number(value)) if is_number(&value) => *to = value,
            (Self::Flag(to), value) => *to = flag(&value)?,
            (Self::Text(to), value) => *to = text(value)?,
            (Self::Bytes(to), Value::Bytes(all)) if all.len() <= MOST_BYTES => *to = all,
            (Self::Steps(to), Value::Numbers(all))
                if all.len() <= MOST_STEPS && all.iter().all(is_number) =>
            {
                *to = all;
            }
            _ => return Err(Error::InvalidField),
        }
        Ok(())
    }

    /// Writes the field.
    pub(super) fn write(self, to: &mut dyn Sink, key: &str) {
        let value = match self {
            Self::MaybePlace(None) => return,
            Self::Part(part) => return part.write(to, key),
            Self::Place(value) | Self::MaybePlace(Some(value)) => number(*value),
            Self::Count(value) => number(*value),
            Self::Number(value) => Value::Number(*value),
            Self::Flag(value) => Value::Flag(*value),
            Self::Text(value) => Value::Text(std::mem::take(value)),
            Self::Bytes(value) => Value::Bytes(std::mem::take(value)),
            Self::Steps(value) => Value::Numbers(std::mem::take(value)),
        };
        to.put(key, value);
    }
}

pub(super) fn number(value: impl Into<f64>) -> Value {
    Value::Number(value.into())
}

fn is_number(value: &f64) -> bool {
    (-LARGEST..=LARGEST).contains(value)
}

pub(super) fn whole(value: &Value, high: u32) -> Result<u32, Error> {
    match *value {
        Value::Number(value) if value.fract() == 0.0 && (0.0..=high.into()).contains(&value) => {
            Ok(value as u32)
        }
        _ => Err(Error::InvalidField),
    }
}

pub(super) fn flag(value: &Value) -> Result<bool, Error> {
    match *value {
        Value::Flag(value) => Ok(value),
        _ => Err(Error::InvalidField),
    }
}

pub(super) fn text(value: Value) -> Result<String, Error> {
    match value {
        Value::Text(value) if value.len() <= LONGEST => Ok(value),
        _ => Err(Error::InvalidField),
    }
}
