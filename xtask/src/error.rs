//! Errors, divided by what the caller does with them.

use std::path::Path;

/// The result of everything here that can fail.
pub(crate) type Result<T> = std::result::Result<T, Error>;

/// The reason why a command stopped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Error {
    /// The command line is wrong: exit code 2.
    Usage(String),
    /// Something was tried and failed: exit code 1.
    Failed(String),
    /// A tool or an input is missing. A test stage may be skipped for it.
    Missing(String),
    /// An optional input is missing. A test stage that needs it is left out, also in CI.
    LeftOut(String),
}

impl Error {
    /// Returns the text for the user.
    pub(crate) fn message(&self) -> &str {
        match self {
            Error::Usage(text)
            | Error::Failed(text)
            | Error::Missing(text)
            | Error::LeftOut(text) => text,
        }
    }

    /// A file operation that failed, with the path that the bare `io::Error` lacks.
    pub(crate) fn io(doing: &str, path: &Path, error: &std::io::Error) -> Error {
        Error::Failed(format!("cannot {doing} {}: {error}", path.display()))
    }
}
