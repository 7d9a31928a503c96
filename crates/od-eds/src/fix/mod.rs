//! Fixes: edits of the text that touch no other line.
//!
//! A check tells what to write and where ([`Fix`]); [`plan`] turns the fixes of a text
//! into replacements that do not overlap, and [`fix`] applies them to a
//! document, round by round until none are left. Text without an edit
//! keeps its bytes, whatever the encoding and the line ends.
//!
//! ```
//! use od_eds::Document;
//! use od_eds::fix::{self, Applicability};
//!
//! let file = Document::new(b"[2000]\r\nParameterName=a\r\nDataType:5\r\n");
//! let fixed = fix::fix(&file, Applicability::Safe, |file| file.load().findings);
//! assert_eq!(fixed.document.bytes(), b"[2000]\r\nParameterName=a\r\nDataType=5\r\n");
//! ```

use alloc::string::String;
use alloc::vec::Vec;

use crate::span::{Span, token_of};

mod fixed;
mod plan;

pub use fixed::{Fixed, Held, Why, fix};
pub use plan::{TextEdit, apply, plan};

/// Whether a fix may be applied without a review.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Applicability {
    /// The meaning of the file does not change.
    Safe,
    /// It changes the meaning of the file, in the way that is most likely intended.
    Unsafe,
}

/// The edits that remove one finding; either all of them are applied or none.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fix {
    /// Whether it may be applied without a review.
    pub applicability: Applicability,
    /// Edits of the text.
    pub edits: Vec<Edit>,
}

/// One edit of a fix.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Edit {
    /// The text to edit.
    pub span: Span,
    /// Change of that text.
    pub action: Action,
    /// Text to write, `\n` for the line end of the file.
    pub text: String,
}

/// Change that an edit makes at its span.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Action {
    /// The text replaces the span.
    Replace,
    /// The text becomes new lines above the line of the span.
    InsertAbove,
    /// The text becomes new lines below the line of the span.
    InsertBelow,
    /// The line of the span is removed, with its line end.
    RemoveLine,
}

impl Fix {
    /// A fix that needs no review; edits are added to it.
    pub const fn safe() -> Self {
        Self::new(Applicability::Safe)
    }

    /// A fix that needs a review; edits are added to it.
    pub const fn unsafe_fix() -> Self {
        Self::new(Applicability::Unsafe)
    }

    const fn new(applicability: Applicability) -> Self {
        Self {
            applicability,
            edits: Vec::new(),
        }
    }

    /// Writes `text` in place of `span`.
    #[must_use]
    pub fn replace(self, span: Span, text: impl Into<String>) -> Self {
        self.edit(span, Action::Replace, text)
    }

    /// Writes lines below the line of `span`.
    #[must_use]
    pub fn below(self, span: Span, text: impl Into<String>) -> Self {
        self.edit(span, Action::InsertBelow, text)
    }

    /// Writes lines above the line of `span`.
    #[must_use]
    pub fn above(self, span: Span, text: impl Into<String>) -> Self {
        self.edit(span, Action::InsertAbove, text)
    }

    /// Turns a line into a comment.
    #[must_use]
    pub(crate) fn comment_out(self, line: Span) -> Self {
        let start = Span {
            end: line.start,
            ..line
        };
        self.replace(start, ";")
    }

    /// Removes the line of `span`.
    #[must_use]
    pub fn remove_line(self, span: Span) -> Self {
        self.edit(span, Action::RemoveLine, "")
    }

    fn edit(mut self, span: Span, action: Action, text: impl Into<String>) -> Self {
        let text = text.into();
        self.edits.push(Edit { span, action, text });
        self
    }

    /// The fix, unless one of its edits has no place in a text.
    pub(crate) fn placed(self) -> Option<Self> {
        let nowhere = |edit: &Edit| edit.span.line == 0 || token_of(edit.span).is_some();
        let placed = !self.edits.is_empty() && !self.edits.iter().any(nowhere);
        placed.then_some(self)
    }
}
