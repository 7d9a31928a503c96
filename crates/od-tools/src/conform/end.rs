//! Early end of a step of a case.

use crate::error::Error;

/// Reason why a step is the last one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum End {
    /// The node does something else.
    Fail {
        /// The expected behaviour.
        expected: String,
        /// The actual behaviour.
        got: String,
    },
    /// It cannot be tested here.
    Skip(String),
    /// The node does not have it.
    NotApplicable(String),
    /// The link is lost.
    Lost(Error),
}

/// Result of a step.
pub(crate) type Checked<T = ()> = Result<T, End>;

impl From<Error> for End {
    fn from(fault: Error) -> Self {
        Self::Lost(fault)
    }
}

/// The node does something else.
pub(crate) fn fail<T>(expected: impl Into<String>, got: impl Into<String>) -> Checked<T> {
    Err(End::Fail {
        expected: expected.into(),
        got: got.into(),
    })
}

/// The node does not have it.
pub(crate) fn lacks<T>(why: impl Into<String>) -> Checked<T> {
    Err(End::NotApplicable(why.into()))
}

/// It cannot be tested here.
pub(crate) fn skip<T>(why: impl Into<String>) -> Checked<T> {
    Err(End::Skip(why.into()))
}

/// Fails unless it holds.
pub(crate) fn ensure(holds: bool, expected: impl Into<String>, got: impl Into<String>) -> Checked {
    if holds { Ok(()) } else { fail(expected, got) }
}
