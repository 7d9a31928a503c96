//! A complete device as one value, for a host that offers several.

use std::boxed::Box;

use od_model::Dictionary;

use crate::application::Application;
use crate::device::Device;
use crate::encoder::EncoderProfile;
use crate::profile::Profile;
use crate::services::Services;

/// Product: names, dictionary, family and behaviour.
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
    /// Its behaviour.
    pub behaviour: Behaviour,
    /// Whether it has the dual LED of the bus cover.
    pub leds: bool,
    /// Number of channels on its shaft, each a node of its own on the same bus: 2 in a redundant
    /// encoder, else 1.
    pub channels: u8,
}

/// The behaviour of a product.
#[derive(Clone, Copy, Debug)]
pub enum Behaviour {
    /// An encoder with these options and deviations relative to CiA 406. The host supplies its
    /// shaft.
    Encoder(&'static EncoderProfile),
    /// An application of its own, which this function makes.
    Own(fn() -> Box<dyn Own>),
}

/// Application of a product that a host can copy.
pub trait Own: Application + Send {
    /// Returns a copy with the same state.
    fn copy(&self) -> Box<dyn Own>;
}

impl<A: Application + Clone + Send + 'static> Own for A {
    fn copy(&self) -> Box<dyn Own> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Own> {
    fn clone(&self) -> Self {
        (**self).copy()
    }
}

impl DeviceKind {
    /// Options and deviations of an encoder relative to CiA 406; `None`: it is not an encoder.
    pub const fn encoder(&self) -> Option<&'static EncoderProfile> {
        match self.behaviour {
            Behaviour::Encoder(profile) => Some(profile),
            Behaviour::Own(_) => None,
        }
    }
}

impl Services for DeviceKind {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

/// A device on a host has every service.
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
