//! CANopen device descriptions as text (CiA 306-1, CiA 311): read, check, fix, patch, compare,
//! write.
//!
//! The crate needs `alloc`, not `std`: it takes and returns text and uses no files.
//!
//! [`parse`] never fails: it returns the parts that it could read, and a finding for
//! everything else, each with its place in the text. It keeps invalid values as text
//! in `extra`, so that [`write()`] loses nothing.
//!
//! ```
//! use od_eds::Value;
//! use od_model::Address;
//!
//! let loaded = od_eds::load("[2300]\nParameterName=Reset\nDataType=0x0005\nAccessType=rw\nDefaultValue=300\n");
//! let fault = &loaded.findings.iter().find(|d| d.code() == "E0412").unwrap();
//! assert_eq!(fault.span().unwrap().line, 5);
//! let reset = loaded.description.entry(Address::new(0x2300, 0)).unwrap();
//! assert_eq!(reset.default.as_ref().unwrap().value, Value::Unsigned(300));
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

extern crate alloc;
#[cfg(test)]
extern crate std;

mod allow;
mod catalogue;
pub mod check;
mod codes;
pub mod convert;
mod description;
pub mod diff;
mod document;
mod fact;
mod finding;
pub mod fix;
mod foreign;
pub mod identifiers;
mod load;
mod log;
pub mod network;
mod overlay;
pub mod patch;
mod read;
pub mod row;
mod rules;
mod scan;
mod span;
mod standards;
mod subject;
#[cfg(feature = "tools")]
pub mod tools;
mod write;
#[cfg(feature = "xdd")]
pub mod xdd;

pub use catalogue::{Eds, Label, Sentence, Vocabulary, say};
pub use description::tables::Tables;
pub use description::{
    Commissioning, Description, EntryDescription, ObjectDescription, Section, Value,
};
pub use document::offsets::Offsets;
pub use document::{Document, Edit, EditError, is_xml};
pub use fact::{Fact, Key, shown};
pub use finding::{Finding, Form, Place, Related, Severity};
pub use foreign::{foreign, lacks_sections};
pub use load::Parsed;
pub use load::{load, parse};
pub use overlay::{Origin, Overlaid, base_of, overlay};
pub use read::modules::{Count, Extension, Module, connected_modules, modules, with_modules};
pub use scan::encoding::{Encoding, decode};
pub use scan::forms::nearest;
pub use span::{Span, Spanned, token, token_of};
pub use write::canonical::{canonical, complete};
pub use write::describe::{About, describe};
pub use write::eds::write;

/// The text of an EDS for a tool that edits it: sections, keys and values with their places, and
/// their descriptions in CiA 306 and CiA 301.
pub mod outline {
    pub use crate::scan::forms::{Form, OBJECT_KEYS, SECTIONS, SectionForm, key, section};
    pub use crate::scan::lines::sections;
    pub use crate::scan::names::{Compact, List, Place, place};
    pub use crate::scan::number::{before_comment, number};
    pub use crate::scan::section::{Text, TextSection};
    pub use crate::standards::cia301::{Specified, data_type, specified};
    pub use crate::standards::{
        meaning, meaning_of_bytes, meanings, profile_name, profile_objects, profile_types,
    };
}
