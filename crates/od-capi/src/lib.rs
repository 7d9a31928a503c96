//! A CANopen node for C firmware.
//!
//! [`export!`] makes of a dictionary the functions that `include/odkit.h` declares; a crate of type
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
//! No allocation, and no panic. Null pointers, sizes that do not fit and calls in the wrong state are
//! answered with an error code. Only this crate of odkit has `unsafe`, since pointers come from C.
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
