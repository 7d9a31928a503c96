//! Types of the fields of inputs.

use std::prelude::v1::*;

use super::choice::choice;
use super::field::{Declared, Error, Fields, Part, Sink, Value, Within, flag, number, text, whole};

choice! {
    /// Source of a device.
    Source by "kind" {
        /// A built-in device.
        "builtin" Builtin { "name" name: String, }
        /// An EDS or DCF text; `lenient`: the device runs as far as the text allows.
        "eds" Eds { "name" name: String, "text" text: String, "lenient" lenient: bool, }
    }
}

impl Eq for Source {}

impl Default for Source {
    fn default() -> Self {
        let name = String::new();
        Self::Builtin { name }
    }
}

impl Source {
    /// Name of the built-in device or of the file.
    pub fn name(&self) -> &str {
        match self {
            Self::Builtin { name } | Self::Eds { name, .. } => name,
        }
    }
}

/// One of the DIP switches of the bit rate.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Dip {
    /// Its bit: 1, 2 or 4.
    pub bit: u8,
    /// Its position.
    pub on: bool,
}

/// Bit rate of the outside in kbit/s; `None`: that of the first device.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Rate(pub Option<u32>);

impl Declared for Source {
    const TYPE: &'static str = "Source";
}

impl Part for Source {
    fn read(&mut self, mut from: &dyn Fields, key: &str) -> Result<(), Error> {
        let from = Within(&mut from, key);
        *self = Self::read(&text(from.get("kind"))?, &from)?;
        Ok(())
    }

    fn write(&mut self, to: &mut dyn Sink, key: &str) {
        std::mem::take(self).write(&mut Within(to, key));
    }
}

impl Declared for Option<Dip> {
    const MARK: &'static str = "?";
    const TYPE: &'static str = "{ bit: number; on: boolean }";
}

impl Part for Option<Dip> {
    fn read(&mut self, mut from: &dyn Fields, key: &str) -> Result<(), Error> {
        let from = Within(&mut from, key);
        *self = match from.get("bit") {
            Value::Missing => None,
            bit => Some(Dip {
                bit: whole(&bit, 7)? as u8,
                on: flag(&from.get("on"))?,
            }),
        };
        Ok(())
    }

    fn write(&mut self, to: &mut dyn Sink, key: &str) {
        if let Some(Dip { bit, on }) = self {
            let mut to = Within(to, key);
            to.put("bit", number(*bit));
            to.put("on", Value::Flag(*on));
        }
    }
}

impl Declared for Rate {
    const TYPE: &'static str = "number | null";
}

impl Part for Rate {
    fn read(&mut self, from: &dyn Fields, key: &str) -> Result<(), Error> {
        self.0 = match from.get(key) {
            Value::Null => None,
            value => Some(whole(&value, u32::MAX)?),
        };
        Ok(())
    }

    fn write(&mut self, to: &mut dyn Sink, key: &str) {
        to.put(key, self.0.map_or(Value::Null, number));
    }
}
