//! Virtual CANopen absolute encoders: their dictionaries, and the differences of their families.
//!
//! Each family is one module, made from one EDS file; [`DEVICES`] lists all devices.
//! Everything here is `const` data for `od-runtime`.
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

#[cfg(feature = "text")]
extern crate std;

pub mod bus_cover;
pub mod eam;
mod eam_diagnosis;
pub mod en580c;
#[cfg(feature = "text")]
pub mod text;

use bus_cover::gxmm;
use eam::eam_mt;
use odkit::DeviceKind;

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
