//! A frame as a filter looks at it, and a mistake in a filter's text.

use std::fmt;

use od_wire::Frame;

/// A frame as a filter looks at it.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'f> {
    /// The frame.
    pub frame: &'f Frame,
    /// It was sent from here.
    pub sent: bool,
    /// Its meaning in words.
    pub words: &'f str,
}

/// A mistake in the text of a filter.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Mistake {
    /// Its place, in bytes from the start.
    pub at: usize,
    /// The mistake in words.
    pub what: String,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (at character {})", self.what, self.at + 1)
    }
}

pub(super) fn mistake(at: usize, what: impl Into<String>) -> Mistake {
    let what = what.into();
    Mistake { at, what }
}
