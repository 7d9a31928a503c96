//! Fixes: edits of the text that touch no other line.
//!
//! A check says what to write and where ([`Fix`]); [`plan`] turns the fixes of a text
//! into plain replacements that do not meet, and [`fix`] applies them to a
//! document, round by round until there is nothing left to do. What no edit is about
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

/// May a fix be applied without looking at it?
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Applicability {
    /// It says to every reader what odkit read before.
    Safe,
    /// It changes what the file says, in the way that is most likely meant.
    Unsafe,
}

/// The edits that remove one finding: all of them together, or none.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fix {
    /// May it be applied without looking at it?
    pub applicability: Applicability,
    /// Edits of the text.
    pub edits: Vec<Edit>,
}

/// One edit of a fix.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Edit {
    /// The stretch of text that it is about.
    pub span: Span,
    /// Action on that text.
    pub action: Action,
    /// Text to write, `\n` for the line end of the file.
    pub text: String,
}

/// Action of an edit on its span.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Action {
    /// The text takes the place of the span.
    Replace,
    /// The text makes lines of its own above the line of the span.
    InsertAbove,
    /// The text makes lines of its own below the line of the span.
    InsertBelow,
    /// The line of the span goes, with its line end.
    RemoveLine,
}

impl Fix {
    /// A fix that needs no second look; edits are added to it.
    pub const fn safe() -> Self {
        Self::new(Applicability::Safe)
    }

    /// A fix to be reviewed; edits are added to it.
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

    /// Makes a comment of a line.
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
