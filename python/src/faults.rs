//! Reasons of this package, as Python exceptions.

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
