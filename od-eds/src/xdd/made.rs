//! A section as an EDS has it, made of elements and attributes.

use alloc::borrow::Cow;
use alloc::string::String;

use crate::scan::placed::Placed;
use crate::span::{Span, Spanned};

/// A section in the making.
pub(super) struct Made {
    pub(super) placed: Placed<'static>,
}

impl Made {
    /// A section without keys.
    pub(super) fn new(name: impl Into<String>, header: Span) -> Self {
        Self {
            placed: Placed::new(Spanned::new(Cow::Owned(name.into()), header), header),
        }
    }

    /// Adds a key, if there is a value for it and the key is not there yet.
    pub(super) fn put(&mut self, key: &str, value: Option<Spanned<String>>) {
        if let Some(value) = value
            && self.placed.get(key).is_none()
        {
            let key = Spanned::new(Cow::Owned(key.into()), value.span);
            let value = Spanned::new(Cow::Owned(value.value), value.span);
            self.placed.pairs.push((key, value));
        }
    }
}
