//! A finished device as one value, for whoever offers several to choose from.

use od_model::Dictionary;

use crate::encoder::{Encoder, EncoderProfile};
use crate::profile::Profile;

/// An encoder that is made: its names, its dictionary, and what its family does differently.
#[derive(Clone, Copy, Debug)]
pub struct DeviceKind {
    /// Its name on a command line, in lower case.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// The family, as the folder of its conformance scripts is called.
    pub family: &'static str,
    /// Its object dictionary.
    pub dictionary: Dictionary<'static>,
    /// What its family does differently from CiA 301.
    pub profile: &'static Profile,
    /// What its family does differently from CiA 406.
    pub encoder: &'static EncoderProfile,
    /// It has the dual LED of the bus cover.
    pub leds: bool,
    /// Channels on its shaft: nodes of their own on one bus, all of this kind. 2 in a
    /// redundant encoder, else 1.
    pub channels: u8,
}

impl DeviceKind {
    /// Returns the encoder behind the dictionary: at angle 0, nothing broken.
    pub fn new_encoder(&self) -> Encoder {
        Encoder::new(self.encoder).with_sensor_of(self.dictionary)
    }
}
