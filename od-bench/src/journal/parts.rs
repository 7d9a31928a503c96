//! Types of the fields of inputs.

use std::prelude::v1::*;

/// Source of a device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Source {
    /// A built-in one.
    Builtin {
        /// Its name.
        name: String,
    },
    /// An EDS or DCF text.
    Eds {
        /// Name of the file.
        name: String,
        /// Its content.
        text: String,
        /// The device runs as far as the text allows.
        lenient: bool,
    },
}

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
    /// Its place.
    pub on: bool,
}

/// Bit rate of the outside in kbit/s; `None`: that of the first device.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Rate(pub Option<u32>);
