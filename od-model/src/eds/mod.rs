//! EDS and DCF text (CiA 306-1): read, check, write.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use crate::{Description, Diagnostic};

/// What a text says, and what is to be said about the text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// Everything that was understood.
    pub description: Description,
    /// Everything else, in file order.
    pub diagnostics: Vec<Diagnostic>,
}

/// The text of a file, whatever its encoding.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// Reads an EDS or a DCF. Never fails; what cannot be read is a diagnostic.
pub fn parse(text: &str) -> Parsed {
    let _ = text;
    Parsed::default()
}

/// Reads and checks an EDS or a DCF: [`parse`], then [`check`](crate::check::check).
pub fn load(text: &str) -> Parsed {
    let mut parsed = parse(text);
    parsed
        .diagnostics
        .extend(crate::check::check(&parsed.description));
    parsed
}

/// The canonical text of a description.
pub fn write(description: &Description) -> String {
    let _ = description;
    String::new()
}
