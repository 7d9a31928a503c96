//! Errors on a bus, as Python exceptions.

use od_model::Address;
use od_tools::Error;
use od_wire::{AbortReason, NodeId};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt, PyOSError, PyTimeoutError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    odkit,
    NodeError,
    PyException,
    "A node violated the protocol, or refused a service."
);
create_exception!(
    odkit,
    SdoAbort,
    NodeError,
    "A node aborts an SDO transfer; `code` is the abort code of CiA 301, such as 0x06020000."
);

/// The exception of a fault.
pub(crate) fn raised(fault: Error) -> PyErr {
    match fault {
        Error::Usage(text) => PyValueError::new_err(text),
        Error::Link(text) => PyOSError::new_err(text),
        Error::Node(text) | Error::Protocol(text) => NodeError::new_err(text),
        Error::Interrupted => PyKeyboardInterrupt::new_err(()),
        other => PyOSError::new_err(other.to_string()),
    }
}

/// The exception of a transfer.
pub(crate) fn of_transfer(
    py: Python<'_>,
    node: NodeId,
    address: Address,
    error: od_client::Error,
    seconds: f32,
) -> PyErr {
    match error {
        od_client::Error::Abort(code) => {
            let text = AbortReason(code).text();
            let error =
                SdoAbort::new_err(format!("node {node}: {address}: abort {code:08X}h: {text}"));
            // An exception object accepts any attribute.
            _ = error.value(py).setattr("code", code);
            error
        }
        od_client::Error::Silent => PyTimeoutError::new_err(format!(
            "node {node} does not respond to SDO requests within {seconds} s; check its power, its NMT \
             state (not Stopped) and its node ID"
        )),
        other => NodeError::new_err(format!("node {node}: {address}: {other}")),
    }
}
