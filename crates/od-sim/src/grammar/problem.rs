//! A mistake in a line.

use std::fmt;
use std::prelude::v1::*;

/// A mistake in a line, its place, and the text to write instead.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Problem {
    /// Counted from 1.
    pub line: u32,
    /// In characters, counted from 1.
    pub column: usize,
    /// The problem, one clause.
    pub message: String,
    /// Text to write instead.
    pub help: String,
}

impl Problem {
    /// A problem of a whole line.
    pub fn new(line: u32, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            line,
            column: 1,
            message: message.into(),
            help: help.into(),
        }
    }

    /// A problem of a text of one line, from a character on.
    pub(crate) fn at(column: usize, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            column,
            ..Self::new(1, message, help)
        }
    }

    /// The same problem in a line in which `before` characters precede the text.
    pub(crate) fn shifted(mut self, before: usize) -> Self {
        self.column += before;
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            line,
            column,
            message,
            help,
        } = self;
        write!(f, "{line}:{column}: {message}; {help}")
    }
}

impl core::error::Error for Problem {}
