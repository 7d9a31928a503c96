//! Fields of an input as a program outside hands them over, and the checks on them: they may come
//! from a link that anybody wrote.

use std::format;
use std::prelude::v1::*;

use super::parts::{Dip, Rate, Source};

/// Most bytes of an input, and most steps of a profile.
const MOST_BYTES: usize = 150_000;
const MOST_STEPS: usize = 2000;
/// Most bytes of an EDS text or a lesson.
const LONGEST: usize = 8_000_000;
/// Largest number, and smallest.
const LARGEST: f64 = 1e9;

/// A value of a field.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// The field is not there.
    Missing,
    /// There is no value.
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

/// Why an input cannot be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// A field is missing, or has a value that is not allowed.
    Cut,
    /// A later version wrote it.
    Newer,
}

/// Source of the fields. A field of a field is named `source.name`.
pub trait Fields {
    /// Returns the value of a field.
    fn get(&self, key: &str) -> Value;
}

/// Destination of the fields.
pub trait Sink {
    /// Takes the value of a field.
    fn put(&mut self, key: &str, value: Value);
}

/// A field of an input, to be read or written.
pub(super) enum Field<'a> {
    Place(&'a mut u8),
    MaybePlace(&'a mut Option<u8>),
    Count(&'a mut u32),
    Number(&'a mut f64),
    Flag(&'a mut bool),
    Text(&'a mut String),
    Bytes(&'a mut Vec<u8>),
    Steps(&'a mut Vec<f64>),
    Source(&'a mut Source),
    Dip(&'a mut Option<Dip>),
    Rate(&'a mut Rate),
}

macro_rules! fields {
    ($($kind:ty => $name:ident,)*) => {
        $(impl<'a> From<&'a mut $kind> for Field<'a> {
            fn from(field: &'a mut $kind) -> Self {
                Self::$name(field)
            }
        })*
    };
}

fields! {
    u8 => Place,
    Option<u8> => MaybePlace,
    u32 => Count,
    f64 => Number,
    bool => Flag,
    String => Text,
    Vec<u8> => Bytes,
    Vec<f64> => Steps,
    Source => Source,
    Option<Dip> => Dip,
    Rate => Rate,
}

impl Field<'_> {
    /// Reads the field.
    pub(super) fn read(self, from: &dyn Fields, key: &str) -> Result<(), Fault> {
        let part = |part| from.get(&format!("{key}.{part}"));
        match (self, from.get(key)) {
            (Self::Dip(to), _) => {
                *to = match part("bit") {
                    Value::Missing => None,
                    bit => Some(Dip {
                        bit: whole(&bit, 7)? as u8,
                        on: flag(&part("on"))?,
                    }),
                };
            }
            (Self::Source(to), _) => {
                let (kind, name) = (text(part("kind"))?, text(part("name"))?);
                *to = match kind.as_str() {
                    "builtin" => Source::Builtin { name },
                    "eds" => Source::Eds {
                        name,
                        text: text(part("text"))?,
                        lenient: flag(&part("lenient"))?,
                    },
                    _ => return Err(Fault::Newer),
                };
            }
            (Self::MaybePlace(to), Value::Missing) => *to = None,
            (Self::MaybePlace(to), value) => *to = Some(whole(&value, 255)? as u8),
            (Self::Rate(to), Value::Null) => to.0 = None,
            (Self::Rate(to), value) => to.0 = Some(whole(&value, u32::MAX)?),
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
            _ => return Err(Fault::Cut),
        }
        Ok(())
    }

    /// The mark of a field that may be missing, and its type in TypeScript.
    pub(super) fn declaration(&self) -> (&'static str, &'static str) {
        match self {
            Self::Place(_) | Self::Count(_) | Self::Number(_) => ("", "number"),
            Self::MaybePlace(_) => ("?", "number"),
            Self::Flag(_) => ("", "boolean"),
            Self::Text(_) => ("", "string"),
            Self::Bytes(_) => ("", "Uint8Array"),
            Self::Steps(_) => ("", "number[]"),
            Self::Source(_) => ("", "Source"),
            Self::Dip(_) => ("?", "{ bit: number; on: boolean }"),
            Self::Rate(_) => ("", "number | null"),
        }
    }

    /// Writes the field.
    pub(super) fn write(self, to: &mut dyn Sink, key: &str) {
        let mut part = |part, value| to.put(&format!("{key}.{part}"), value);
        let value = match self {
            Self::Dip(None) | Self::MaybePlace(None) => return,
            Self::Dip(Some(Dip { bit, on })) => {
                part("bit", number(*bit));
                return part("on", Value::Flag(*on));
            }
            Self::Source(source) => {
                let kind = match source {
                    Source::Builtin { .. } => "builtin",
                    Source::Eds { .. } => "eds",
                };
                part("kind", Value::Text(kind.into()));
                part("name", Value::Text(source.name().into()));
                if let Source::Eds { text, lenient, .. } = source {
                    part("text", Value::Text(std::mem::take(text)));
                    part("lenient", Value::Flag(*lenient));
                }
                return;
            }
            Self::Place(value) | Self::MaybePlace(Some(value)) => number(*value),
            Self::Count(value) => number(*value),
            Self::Number(value) => Value::Number(*value),
            Self::Flag(value) => Value::Flag(*value),
            Self::Text(value) => Value::Text(std::mem::take(value)),
            Self::Bytes(value) => Value::Bytes(std::mem::take(value)),
            Self::Steps(value) => Value::Numbers(std::mem::take(value)),
            Self::Rate(Rate(rate)) => rate.map_or(Value::Null, number),
        };
        to.put(key, value);
    }
}

fn number(value: impl Into<f64>) -> Value {
    Value::Number(value.into())
}

fn is_number(value: &f64) -> bool {
    (-LARGEST..=LARGEST).contains(value)
}

fn whole(value: &Value, high: u32) -> Result<u32, Fault> {
    match *value {
        Value::Number(value) if value.fract() == 0.0 && (0.0..=high.into()).contains(&value) => {
            Ok(value as u32)
        }
        _ => Err(Fault::Cut),
    }
}

fn flag(value: &Value) -> Result<bool, Fault> {
    match *value {
        Value::Flag(value) => Ok(value),
        _ => Err(Fault::Cut),
    }
}

fn text(value: Value) -> Result<String, Fault> {
    match value {
        Value::Text(value) if value.len() <= LONGEST => Ok(value),
        _ => Err(Fault::Cut),
    }
}
