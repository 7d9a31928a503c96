//! The behaviour of a device, and the shaft of an encoder.

use std::prelude::v1::*;

use od_model::Dictionary;
use od_runtime::Application;
use od_runtime::encoder::Encoder;

use crate::plain::Plain;
use crate::shaft::{self, Shaft};

/// Behaviour behind the dictionary.
pub(crate) enum Behaviour {
    Encoder(Box<Encoder<Shaft>>),
    Plain(Plain),
    Other(Box<dyn Application + Send>),
}

impl Behaviour {
    /// An encoder where there is a position (6004h), else nothing.
    pub(crate) fn of(dictionary: Dictionary<'_>) -> Self {
        match shaft::encoder_of(dictionary) {
            Some(encoder) => Self::Encoder(Box::new(encoder)),
            None => Self::Plain(Plain::default()),
        }
    }

    /// A copy; `None` of behaviour of one's own.
    pub(crate) fn copy(&self) -> Option<Self> {
        match self {
            Self::Encoder(encoder) => Some(Self::Encoder(encoder.clone())),
            Self::Plain(plain) => Some(Self::Plain(*plain)),
            Self::Other(_) => None,
        }
    }

    pub(crate) fn as_application(&mut self) -> &mut dyn Application {
        match self {
            Self::Encoder(encoder) => &mut **encoder,
            Self::Plain(plain) => plain,
            Self::Other(other) => &mut **other,
        }
    }
}
