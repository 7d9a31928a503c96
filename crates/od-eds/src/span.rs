//! Places in a text, or tokens of a macro call.

use core::ops::Deref;

/// A range of the parsed text.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Span {
    /// First byte, counted from 0.
    pub start: u32,
    /// The byte after the last one.
    pub end: u32,
    /// Line of the first byte, counted from 1; 0 if it has no text.
    pub line: u32,
    /// Column of the first byte, in characters, counted from 1.
    pub column: u32,
}

impl Span {
    /// Returns this place, or the other one if this one is in no text.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        match self.line {
            0 => other,
            _ => self,
        }
    }
}

/// A span for the caller's token number `id`, which is not a range of text.
///
/// The macro numbers its tokens, puts these spans into its edits, and finds the token of a finding
/// with [`token_of`].
pub const fn token(id: u32) -> Span {
    Span {
        start: id,
        end: id,
        line: u32::MAX,
        column: 0,
    }
}

/// The number of a span made by [`token`]; `None` for a place in a text.
pub const fn token_of(span: Span) -> Option<u32> {
    if span.line == u32::MAX {
        Some(span.start)
    } else {
        None
    }
}

/// A value and the place from which it was read. Two are equal if their values are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its place; line 0 if it has no text.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value with its place.
    pub const fn new(value: T, span: Span) -> Self {
        Self { value, span }
    }
}

impl<T> From<T> for Spanned<T> {
    fn from(value: T) -> Self {
        Self {
            value,
            span: Span::default(),
        }
    }
}

impl<T: PartialEq> PartialEq for Spanned<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}
impl<T: Eq> Eq for Spanned<T> {}

impl<T> Deref for Spanned<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}
