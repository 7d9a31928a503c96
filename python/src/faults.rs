//! Reasons of this package, as Python exceptions.

use std::io;
use std::path::Path;

use od_sim::serve::files;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyTimeoutError, PyValueError};
use pyo3::prelude::*;

/// Reason why an action fails.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Fault {
    /// The caller requests something that does not exist or is not valid: `ValueError`.
    Value(String),
    /// A file does not exist: `FileNotFoundError`.
    Missing(String),
    /// The bus or a file fails: `OSError`.
    System(String),
    /// The time-out has passed: `TimeoutError`.
    Late(String),
}

impl Fault {
    /// A `ValueError` with this sentence.
    pub(crate) fn value(text: impl Into<String>) -> Self {
        Self::Value(text.into())
    }

    /// An `OSError` with this sentence.
    pub(crate) fn system(text: impl Into<String>) -> Self {
        Self::System(text.into())
    }
}

impl Fault {
    /// Its sentence.
    pub(crate) fn text(&self) -> &str {
        match self {
            Self::Value(text) | Self::Missing(text) | Self::System(text) | Self::Late(text) => text,
        }
    }
}

impl<T: Into<String>> From<T> for Fault {
    fn from(text: T) -> Self {
        Self::value(text)
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Value(text) => PyValueError::new_err(text),
            Fault::Missing(text) => PyFileNotFoundError::new_err(text),
            Fault::System(text) => PyOSError::new_err(text),
            Fault::Late(text) => PyTimeoutError::new_err(text),
        }
    }
}

/// Writes a file in one step: it has its old content or the new one.
///
/// # Errors
/// An `OSError` with the path.
pub(crate) fn write(path: &Path, bytes: impl AsRef<[u8]>) -> PyResult<()> {
    files::replace(&[(path, bytes.as_ref())]).map_err(|(path, error)| of_file(&error, &path))
}

/// The exception of an error of the system about a file, as Python itself raises it: number, text and path.
pub(crate) fn of_file(error: &io::Error, path: &Path) -> PyErr {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    let path = path.as_os_str().to_owned();
    PyOSError::new_err((error.raw_os_error(), text.to_string(), path))
}
