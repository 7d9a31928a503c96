//! Arguments of callers, checked.

use od_wire::nmt::Command;
use od_wire::{Duration, NodeId};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::wire::micros;

/// The node ID.
///
/// # Errors
/// It is not 1 to 127.
pub(crate) fn id_of(node: u8) -> PyResult<NodeId> {
    NodeId::new(node)
        .ok_or_else(|| PyValueError::new_err(format!("{node} is not a node ID; write 1 to 127")))
}

/// A number of seconds.
///
/// # Errors
/// It is negative or not a number.
pub(crate) fn seconds_of(time: f64, what: &str) -> PyResult<Duration> {
    Ok(Duration::from_micros(micros(time, what)?))
}

/// An NMT command.
///
/// # Errors
/// It is another word.
pub(crate) fn command_of(word: &str) -> PyResult<Command> {
    Ok(match word {
        "start" => Command::Start,
        "stop" => Command::Stop,
        "pre-operational" => Command::EnterPreOperational,
        "reset" => Command::ResetNode,
        "reset-communication" => Command::ResetCommunication,
        other => {
            return Err(PyValueError::new_err(format!(
                "NMT command `{other}` is not known; write start, stop, pre-operational, reset or \
                 reset-communication"
            )));
        }
    })
}
