//! A CANopen node for C firmware.
//!
//! [`export!`] makes the functions of `include/odkit.h` for a dictionary. A crate of type
//! `staticlib` with these lines is the library of a device:
//!
//! ```
//! # #![allow(unsafe_code)]
//! odkit::object_dictionary! {
//!     mod device {
//!         without lss, block;
//!         add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
//!         add 0x1001 { name = "Error register"; type = u8 }
//!         add 0x1018 { code = record; name = "Identity object" }
//!         add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
//!     }
//! }
//! od_capi::export!(device);
//! # fn main() {}
//! ```
//!
//! The folder `device` of the repository is such a crate, for the EDS file that the environment
//! variable `ODKIT_EDS` names.
//!
//! The library never allocates and never panics. Null pointers, wrong sizes and calls in the wrong
//! state return an error code. In odkit only this crate and `od-thumb` contain `unsafe`, here
//! because pointers come from C.
#![no_std]
#![warn(clippy::undocumented_unsafe_blocks)]

pub mod answer;
mod application;
mod clock;
mod events;
mod export;
mod frame;
pub mod instance;
mod memory;
mod nested;
mod number;
pub mod types;
mod values;
