//! Early end of a step of a case.

use crate::error::Error;

/// Reason why a case ends at a step.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum End {
    /// The node behaves differently.
    Fail {
        /// The expected behaviour.
        expected: String,
        /// The actual behaviour.
        got: String,
    },
    /// The step cannot be tested on this link.
    Skip(String),
    /// The node does not have the object or service.
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

/// The node behaves differently.
pub(crate) fn fail<T>(expected: impl Into<String>, got: impl Into<String>) -> Checked<T> {
    Err(End::Fail {
        expected: expected.into(),
        got: got.into(),
    })
}

/// The node does not have the object or service.
pub(crate) fn lacks<T>(why: impl Into<String>) -> Checked<T> {
    Err(End::NotApplicable(why.into()))
}

/// Ends a case about several objects: it does not apply if the node has none of them.
pub(crate) fn at_least_one(is_any: bool, why: &str) -> Checked {
    if is_any { Ok(()) } else { lacks(why) }
}

/// The step cannot be tested on this link.
pub(crate) fn skip<T>(why: impl Into<String>) -> Checked<T> {
    Err(End::Skip(why.into()))
}

/// Fails unless the condition is true.
pub(crate) fn ensure(holds: bool, expected: impl Into<String>, got: impl Into<String>) -> Checked {
    if holds { Ok(()) } else { fail(expected, got) }
}

/// The result of a step, or `None` if it is not applicable.
pub(crate) fn optional<T>(found: Checked<T>) -> Checked<Option<T>> {
    match found {
        Err(End::NotApplicable(_)) => Ok(None),
        found => found.map(Some),
    }
}
