//! Virtual CANopen absolute encoders: dictionaries and what their families do differently.
//!
//! Each family is one module, made from one EDS file; [`DEVICES`] lists what there is.
//! Everything here is `const` data for `od-runtime` to work with.
//!
//! ```
//! use od_devices::find;
//!
//! let gxmm = find("gxmm").unwrap();
//! let position = gxmm.dictionary.entry(0x6004, 0).unwrap();
//! assert!(position.maps_to_tpdo());
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "bench")]
extern crate std;

pub mod bus_cover;
#[cfg(feature = "sim")]
pub mod datasheet;
pub mod eam;
mod eam_diagnosis;
pub mod en580c;
#[cfg(feature = "sim")]
mod export;
#[cfg(feature = "bench")]
pub mod sim;

use bus_cover::gxmm;
use eam::eam_mt;
use od_model::Dictionary;
use od_runtime::Profile;
use od_runtime::encoder::{Encoder, EncoderProfile};

/// A device that can be simulated.
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
    /// What is behind its dictionary: an encoder at angle 0, nothing broken.
    pub fn new_encoder(&self) -> Encoder {
        Encoder::new(self.encoder).with_sensor_of(self.dictionary)
    }
}

/// Every device, by family.
pub const DEVICES: &[DeviceKind] = &[
    bus_cover::kind("gxmm", "GXMM, multivo multiturn", gxmm::DICTIONARY),
    bus_cover::kind("gxam", "GXAM, multivo singleturn", gxmm::gxam::DICTIONARY),
    bus_cover::kind("gcmm", "GCMM, magtivo multiturn", gxmm::gcmm::DICTIONARY),
    bus_cover::kind("gcam", "GCAM, magtivo singleturn", gxmm::gcam::DICTIONARY),
    bus_cover::kind("gdmm", "GDMM, activo multiturn", gxmm::gdmm::DICTIONARY),
    bus_cover::kind("gdam", "GDAM, activo singleturn", gxmm::gdam::DICTIONARY),
    bus_cover::kind(
        "gbmm",
        "GBMM, multivoPlus multiturn",
        gxmm::gbmm::DICTIONARY,
    ),
    bus_cover::kind(
        "gbam",
        "GBAM, multivoPlus singleturn",
        gxmm::gbam::DICTIONARY,
    ),
    eam::kind(
        "eam_mt",
        "EAM, magnetic multiturn",
        eam_mt::DICTIONARY,
        &eam::ENCODER,
        1,
    ),
    eam::kind(
        "eam_st",
        "EAM, magnetic singleturn",
        eam_mt::eam_st::DICTIONARY,
        &eam::SINGLETURN,
        1,
    ),
    eam::kind(
        "eam_red",
        "EAM, magnetic multiturn, redundant",
        eam_mt::eam_red::DICTIONARY,
        &eam::REDUNDANT,
        2,
    ),
    en580c::kind("en580c", "EN580C, optical multiturn"),
];

/// The device with this name, in any case.
pub fn find(name: &str) -> Option<&'static DeviceKind> {
    DEVICES
        .iter()
        .find(|kind| kind.name.eq_ignore_ascii_case(name))
}
