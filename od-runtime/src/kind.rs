//! A finished device as one value, for a host that offers several.

use od_model::Dictionary;

use crate::encoder::{EncoderProfile, Sensor};
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
    /// Returns the sensor that profile and dictionary describe.
    pub fn sensor(&self) -> Sensor {
        self.encoder.sensor_of(self.dictionary)
    }
}
