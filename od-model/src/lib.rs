//! The object dictionary of CANopen (CiA 301) as plain data.
//!
//! [`Dictionary`] is a view over sorted tables. The tables are `const` when
//! `od-macros` made them from an EDS file at compile time, and owned
//! ([`Tables`]) when a file was loaded at run time; everything above this crate
//! works on the view and cannot tell the difference.
//!
//! Without features the crate is `no_std` and needs no allocator. Feature `eds`
//! adds the EDS and DCF reader, the checks, variants, and the writer.
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "eds")]
extern crate alloc;
#[cfg(any(feature = "eds", test))]
extern crate std;

mod access;
mod address;
mod dictionary;
mod index;
pub mod typed;
mod types;
mod value;

pub use access::{Access, Group};
pub use address::Address;
pub use dictionary::{Dictionary, Entry, Missing, Object, Slot};
pub use index::{Place, bucket_count, buckets, places};
pub use types::{DataType, Kind, ObjectCode};
pub use value::{Literal, Range};

#[cfg(feature = "eds")]
pub mod check;
#[cfg(feature = "eds")]
mod commission;
#[cfg(feature = "eds")]
mod description;
#[cfg(feature = "eds")]
mod diagnostic;
#[cfg(feature = "eds")]
pub mod diff;
#[cfg(feature = "eds")]
pub mod eds;
#[cfg(feature = "eds")]
pub mod fix;
#[cfg(feature = "eds")]
pub mod patch;
#[cfg(feature = "eds")]
mod tables;
#[cfg(feature = "xdd")]
pub mod xdd;

#[cfg(feature = "eds")]
pub use description::{
    Commissioning, Description, EntryDescription, ObjectDescription, Section, Value,
};
#[cfg(feature = "eds")]
pub use diagnostic::{Diagnostic, Label, Severity, Span, Spanned};
#[cfg(feature = "eds")]
pub use tables::Tables;
