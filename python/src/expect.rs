//! Waiting for a frame.

use od_sim::script::Pattern;
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;

use crate::faults::Fault;
use crate::journal::frame;
use crate::party::Wait;
use crate::pass::{End, pass};
use crate::wire::{Wire, micros};

/// Number of frames in a message.
const SHOWN: usize = 12;

/// Waits for a frame, at most `within` seconds, and returns its line of the log.
///
/// # Errors
/// `AssertionError`: another frame came, or none.
pub(crate) fn expect(py: Python<'_>, wire: &Wire, text: &str, within: f64) -> PyResult<String> {
    let pattern = Pattern::parse(text).map_err(|error| {
        let (column, message, help) = (error.column, error.message, error.help);
        Fault::value(format!("column {column}: {message}; {help}"))
    })?;
    let time = micros(within, "the time for a frame")?;
    let (from, until) = {
        let state = wire.enter(py)?;
        let now = state.now();
        let is_recent = now.micros_since(state.acted) <= time;
        let first = if is_recent { state.acted } else { now };
        (
            state.seen.max(state.journal.at(first)),
            now.plus_micros(time),
        )
    };
    let (mut next, mut found) = (from, None);
    let wait = Wait {
        until: Some(until),
        seen: Some(0),
        ..Wait::default()
    };
    let end = pass(py, wire, wait, false, &mut |state| {
        let mut records = state.journal.since(next).enumerate();
        let at =
            records.find(|(_, record)| frame(record).is_some_and(|frame| pattern.matches(&frame)));
        found = at.map(|(at, _)| next + at);
        next = state.journal.end();
        Ok(found.is_some())
    })?;
    let mut state = wire.lock();
    let came = state.journal.lines(state.bus.devices(), from);
    if let (End::Done, Some(found)) = (end, found) {
        state.seen = found + 1;
        return Ok(came.get(found - from).cloned().unwrap_or_default());
    }
    drop(state);
    let instead = match came.len() {
        0 => String::from("no frame came"),
        count => {
            let more = match count.saturating_sub(SHOWN) {
                0 => String::new(),
                more => format!("\n  and {more} more"),
            };
            let shown: Vec<String> = came
                .into_iter()
                .take(SHOWN)
                .map(|line| format!("  {line}"))
                .collect();
            format!("what came instead:\n{}{more}", shown.join("\n"))
        }
    };
    let message = format!("{} did not come within {within} s; {instead}", text.trim());
    Err(PyAssertionError::new_err(message))
}
