//! What is wrong with a description, as plain data; nothing here is rendered.

use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Deref;

use crate::fix::Fix;
use od_model::Address;

/// How bad it is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Many shipped files have it; a device can be built.
    Warning,
    /// No sound device can be built, or a master fails.
    Error,
}

/// A stretch of the text that was parsed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Span {
    /// First byte, counted from 0.
    pub start: u32,
    /// The byte behind the last one.
    pub end: u32,
    /// Line of the first byte, counted from 1; 0 where there is no text behind it.
    pub line: u32,
    /// Column of the first byte, in characters, counted from 1.
    pub column: u32,
}

/// A second place that belongs to a finding.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there, in a few words.
    pub text: String,
}

/// One finding: stable code, severity, what, where, which object, and how to mend it.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Diagnostic {
    /// Stable code, for example `E0412`. A code never changes its meaning.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, one sentence without a full stop.
    pub message: String,
    /// Where it is; `None` where something is missing altogether.
    pub span: Option<Span>,
    /// The object it is about, if it is about one.
    pub address: Option<Address>,
    /// Second places.
    pub labels: Vec<Label>,
    /// What is allowed, or what to write instead; empty if the message says it.
    pub help: String,
    /// How to mend it without asking, where that can be done.
    pub fix: Option<Fix>,
}

impl Diagnostic {
    /// An error with this code and message; the rest is added with the `with_` functions.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Error, message)
    }

    /// A warning with this code and message.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Warning, message)
    }

    /// A remark with this code and message.
    pub fn info(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(code, Severity::Info, message)
    }

    fn new(code: &'static str, severity: Severity, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            code,
            severity,
            message,
            span: None,
            address: None,
            labels: Vec::new(),
            help: String::new(),
            fix: None,
        }
    }

    /// Says where.
    #[must_use]
    pub fn with_span(mut self, span: Span) -> Self {
        // Line 0 marks a value that never stood in a text.
        self.span = (span.line != 0).then_some(span);
        self
    }

    /// Says which object.
    #[must_use]
    pub fn with_address(mut self, address: Address) -> Self {
        self.address = Some(address);
        self
    }

    /// Adds a second place.
    #[must_use]
    pub fn with_label(mut self, span: Span, text: impl Into<String>) -> Self {
        if span.line != 0 {
            self.labels.push(Label {
                span,
                text: text.into(),
            });
        }
        self
    }

    /// Says how to mend it.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }

    /// Mends it by these edits; by none if one of them has no place in a text.
    #[must_use]
    pub fn with_fix(mut self, fix: Fix) -> Self {
        self.fix = fix.placed();
        self
    }

    /// Is it an error?
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// A value with the place it was read from. Two are equal if their values are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stood; line 0 where it came from no text.
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
