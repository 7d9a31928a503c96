//! A section of a text with its places, from the scanner or made from an XDD.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use crate::span::{Span, Spanned};

/// A piece of the text; owned if it was made, as for an XDD.
pub type Text<'a> = Spanned<Cow<'a, str>>;

/// A section as written in the text.
#[derive(Clone, PartialEq, Debug)]
pub struct TextSection<'a> {
    /// The trimmed text between the brackets; empty for the keys before the first section.
    pub name: Text<'a>,
    /// Keys and values, trimmed, in file order.
    pub pairs: Vec<(Text<'a>, Text<'a>)>,
    /// The brackets and the text between them.
    pub header: Span,
    /// The first `;StorageLocation=` comment.
    pub storage: Option<Text<'a>>,
    /// Keys, in lower case, that later sections of the same name contain, too.
    pub again: Vec<String>,
}

impl<'a> TextSection<'a> {
    /// A section without keys.
    pub(crate) const fn new(name: Text<'a>, header: Span) -> Self {
        Self {
            name,
            header,
            pairs: Vec::new(),
            storage: None,
            again: Vec::new(),
        }
    }

    /// The first value of `key`, in any case.
    pub(crate) fn get(&self, key: &str) -> Option<&Text<'_>> {
        self.pairs
            .iter()
            .find(|(k, _)| k.eq_ignore_ascii_case(key))
            .map(|(_, v)| v)
    }
}

/// Copies a text, so that it does not borrow from the file.
pub(crate) fn owned(text: Text<'_>) -> Spanned<String> {
    Spanned::new(text.value.into_owned(), text.span)
}
