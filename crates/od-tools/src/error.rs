//! The error of this crate.

use std::fmt;

use od_model::Refused;
use od_wire::AbortReason;

/// Reason why a request on a bus failed. The text names the place, the error and the correction.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Error {
    /// The request is not possible: an unknown kind of link, an invalid address or value.
    Usage(String),
    /// A filter cannot be read.
    Filter {
        /// Place of the mistake, in bytes from the start.
        at: usize,
        /// The mistake in words.
        what: String,
    },
    /// A line of a case of the conformance test cannot be read.
    Case {
        /// The case.
        id: String,
        /// Counted from 1.
        line: u32,
        /// The mistake, and the text to write instead.
        message: String,
    },
    /// The link cannot be opened, or is lost.
    Link(String),
    /// A node does not respond, or lacks what a command needs.
    Node(String),
    /// A node violates the protocol, or boots, in the transfer of one object; it may serve its other objects.
    Protocol(String),
    /// The node aborted the SDO transfer with this code (CiA 301, table 22).
    Abort(u32),
    /// The user stopped the program (Ctrl-C).
    Interrupted,
}

impl Error {
    /// Splits the failures of one object, after which a node may serve its other objects, from the other errors.
    ///
    /// # Errors
    /// All but [`Error::Abort`] and [`Error::Protocol`].
    pub fn or_failed<T>(result: Result<T, Self>) -> Result<Result<T, Self>, Self> {
        match result {
            Ok(done) => Ok(Ok(done)),
            Err(failed @ (Self::Abort(_) | Self::Protocol(_))) => Ok(Err(failed)),
            Err(other) => Err(other),
        }
    }

    /// Splits the abort codes from the other errors, for a program that continues after an abort.
    ///
    /// # Errors
    /// All but [`Error::Abort`].
    pub fn or_abort<T>(result: Result<T, Self>) -> Result<Result<T, u32>, Self> {
        match result {
            Ok(done) => Ok(Ok(done)),
            Err(Self::Abort(code)) => Ok(Err(code)),
            Err(other) => Err(other),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(text) | Self::Link(text) | Self::Node(text) | Self::Protocol(text) => {
                f.write_str(text)
            }
            Self::Filter { at, what } => write!(f, "{what} (at character {})", at + 1),
            Self::Case { id, line, message } => write!(f, "{id}.script:{line}: {message}"),
            Self::Abort(code) => write!(f, "SDO abort {}", AbortReason(*code)),
            Self::Interrupted => f.write_str("stopped by Ctrl-C"),
        }
    }
}

impl std::error::Error for Error {}

impl From<Refused> for Error {
    fn from(refused: Refused) -> Self {
        Self::Usage(refused.into())
    }
}
