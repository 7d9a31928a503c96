//! Virtual CANopen devices: twelve absolute encoders, a servo drive, an I/O module.
//!
//! Each family is one module, made from one EDS file; [`DEVICES`] lists all devices.
//! An encoder is `const` data for `od-runtime`; drive and I/O module have their own behaviour, like
//! any device made with `odkit`.
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
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "std")]
extern crate std;

pub mod bus_cover;
pub mod drive;
pub mod eam;
mod eam_diagnosis;
pub mod en580c;
pub mod io;
#[cfg(feature = "text")]
pub mod text;

#[cfg(feature = "std")]
use bus_cover::gxmm;
#[cfg(feature = "std")]
use eam::eam_mt;
#[cfg(feature = "std")]
use odkit::DeviceKind;

/// Name and title of each device that is in [`DEVICES`] only with the feature `machines`.
pub const MACHINES: [(&str, &str); 2] = [
    ("io", "I/O module (CiA 401)"),
    ("drive", "Servo drive with two axes (CiA 402)"),
];

/// Every device, grouped by family.
#[cfg(feature = "std")]
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
    #[cfg(feature = "machines")]
    io::kind(MACHINES[0].0, MACHINES[0].1),
    #[cfg(feature = "machines")]
    drive::kind(MACHINES[1].0, MACHINES[1].1),
];

/// The device with this name, in any case.
#[cfg(feature = "std")]
pub fn find(name: &str) -> Option<&'static DeviceKind> {
    DEVICES
        .iter()
        .find(|kind| kind.name.eq_ignore_ascii_case(name))
}

/// The encoders among the devices.
#[cfg(feature = "std")]
pub fn encoders() -> impl Iterator<Item = &'static DeviceKind> {
    DEVICES.iter().filter(|kind| kind.encoder().is_some())
}
