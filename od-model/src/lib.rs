//! The object dictionary of CANopen (CiA 301) as plain data.
//!
//! [`Dictionary`] is a view over sorted tables. The tables are `const` if `od-macros` made them
//! from an EDS file at compile time, and owned (`od_eds::Tables`) if a file was loaded at run time.
//! All other crates use the view and cannot tell the difference.
//!
//! The crate is `no_std` and needs no allocator. Text formats are in `od-eds`.
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

mod access;
mod address;
mod cob_ids;
mod dictionary;
mod entry;
mod index;
mod needs;
#[doc(hidden)]
pub mod real;
#[cfg(feature = "alloc")]
mod refused;
mod restricted;
#[doc(hidden)]
pub mod row;
mod transmission_type;
pub mod typed;
mod types;
mod value;
#[cfg(feature = "alloc")]
pub mod values;
#[doc(hidden)]
pub mod varying;
#[cfg(feature = "alloc")]
mod visible;

pub use access::{Access, Group};
pub use address::Address;
pub use cob_ids::CobIdService;
pub use dictionary::{Dictionary, Entries, Names, Objects};
pub use entry::{Entry, Missing, Object, Slot};
#[cfg(feature = "alloc")]
pub use refused::Refused;
pub use restricted::{CanIdOwner, is_restricted, restricted};
pub use transmission_type::TransmissionType;
pub use types::{DataType, Kind, ObjectCode};
pub use value::{Literal, Range};
#[cfg(feature = "alloc")]
pub use visible::{Visible, is_hidden};

/// Parts of which `od-eds` makes owned tables; not an API.
#[doc(hidden)]
pub mod owned {
    pub use crate::dictionary::Shape;
    pub use crate::index::{Buckets, EMPTY, SMALL, bucket_count, fill};
}
