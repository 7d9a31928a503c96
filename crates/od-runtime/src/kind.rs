//! A finished device as one value, for a host that offers several.

use od_model::Dictionary;

#[cfg(feature = "std")]
use crate::device::Device;
use crate::encoder::{EncoderProfile, Sensor};
use crate::profile::Profile;
#[cfg(feature = "std")]
use crate::services::Services;

/// Product: names, dictionary and family of an encoder.
#[derive(Clone, Copy, Debug)]
pub struct DeviceKind {
    /// Name on a command line, in lower case.
    pub name: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// Family: the folder of its conformance scripts.
    pub family: &'static str,
    /// Object dictionary.
    pub dictionary: Dictionary<'static>,
    /// Options and deviations of its family relative to CiA 301.
    pub profile: &'static Profile,
    /// Options and deviations of its family relative to CiA 406.
    pub encoder: &'static EncoderProfile,
    /// Whether it has the dual LED of the bus cover.
    pub leds: bool,
    /// Number of channels on its shaft, each a node of its own on the same bus: 2 in a redundant
    /// encoder, else 1.
    pub channels: u8,
}

impl DeviceKind {
    /// Returns the sensor that profile and dictionary describe.
    pub fn sensor(&self) -> Sensor {
        self.encoder.sensor_of(self.dictionary)
    }
}

#[cfg(feature = "std")]
impl Services for DeviceKind {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

/// On a host, with every service.
#[cfg(feature = "std")]
impl Device for DeviceKind {
    type Values = crate::rooms::LoadedValues;
    type Rooms = crate::rooms::LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.dictionary
    }

    fn profile(&self) -> &Profile {
        self.profile
    }
}
