//! EDS and DCF text (CiA 306-1): read, check, write.
//!
//! [`parse`] never fails: it returns what it understood, and a diagnostic for
//! everything else, each with its place in the text. What it cannot make a value
//! of, it keeps as text in `extra`, so that [`write()`] loses nothing.
//!
//! ```
//! use od_model::{Address, Value, eds};
//!
//! let loaded = eds::load("[2300]\nParameterName=Reset\nDataType=0x0005\nAccessType=rw\nDefaultValue=300\n");
//! let fault = &loaded.diagnostics.iter().find(|d| d.code == "E0412").unwrap();
//! assert_eq!(fault.span.unwrap().line, 5);
//! let reset = loaded.description.entry(Address::new(0x2300, 0)).unwrap();
//! assert_eq!(reset.default.as_ref().unwrap().value, Value::Unsigned(300));
//! ```

use alloc::vec::Vec;

use crate::{Description, Diagnostic};

mod canonical;
mod compact;
mod compact_pdo;
mod describe;
mod document;
mod encoding;
mod entry;
mod fields;
mod ini;
pub(crate) mod known;
mod lines;
mod lists;
mod modules;
mod number;
mod object;
mod other;
mod overlay;
mod own_types;
mod parse;
mod sections;
mod values;
mod words;
mod write;

pub use canonical::{canonical, complete};
pub use describe::{About, describe};
pub use document::{Document, Edit, EditError};
pub use encoding::{Encoding, decode};
#[cfg(feature = "xdd")]
pub(crate) use fields::location as storage_name;
#[cfg(feature = "xdd")]
pub(crate) use ini::Placed;
pub(crate) use ini::Text;
pub use modules::{Count, Extension, Module, connected_modules, modules, with_modules};
pub use overlay::{Origin, Overlaid, overlay};
#[cfg(feature = "xdd")]
pub(crate) use parse::from_sections;
pub use parse::parse;
#[cfg(feature = "xdd")]
pub(crate) use values::text as value_text;
pub use write::write;

pub(crate) use lines::lines;
use sections::Place;

/// What a text says, and what is to be said about the text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// Everything that was understood.
    pub description: Description,
    /// Everything else, in file order.
    pub diagnostics: Vec<Diagnostic>,
}

/// The object that the section of this name is about.
pub(crate) fn object_of(name: &str) -> Option<u16> {
    match sections::place(name) {
        Place::Object(index) | Place::Member(index, _) | Place::Compact(index, _) => Some(index),
        Place::List(_) | Place::Other => None,
    }
}

/// A number of a section that describes no object, however it is written.
pub(crate) fn number(text: &str) -> Option<i128> {
    let mut notes = Vec::new();
    let text = number::without_comment(text, &mut notes);
    number::integer(text, &mut notes).map(|number| number.value)
}

/// Reads and checks an EDS or a DCF: [`parse`], then [`check`](crate::check::check),
/// without what the text [allows](crate::check::Allows).
pub fn load(text: &str) -> Parsed {
    checked(parse(text), text)
}

/// What was read, with the findings of all checks.
fn checked(mut parsed: Parsed, text: &str) -> Parsed {
    parsed
        .diagnostics
        .extend(crate::check::check(&parsed.description));
    crate::check::sort(&mut parsed.diagnostics);
    crate::check::Allows::of(text).apply(&mut parsed.diagnostics);
    #[cfg(feature = "xdd")]
    if crate::xdd::is_xml(text) {
        // What mends an EDS would break an XML.
        for finding in &mut parsed.diagnostics {
            finding.fix = None;
        }
    }
    parsed
}
