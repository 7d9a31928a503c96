//! The open buses, by name.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Instant as Clock, SystemTime, UNIX_EPOCH};

use pyo3::prelude::*;

use crate::faults::Fault;
use crate::spec;
use crate::state::State;
use crate::wire::Wire;

static WIRES: Mutex<Vec<Weak<Wire>>> = Mutex::new(Vec::new());
static NUMBER: AtomicU32 = AtomicU32::new(1);

fn open_wires() -> MutexGuard<'static, Vec<Weak<Wire>>> {
    let mut wires = WIRES.lock().unwrap_or_else(PoisonError::into_inner);
    wires.retain(|wire| wire.strong_count() > 0);
    wires
}

/// Names of the open buses.
#[pyfunction]
pub(crate) fn wires() -> Vec<String> {
    let open = open_wires();
    open.iter()
        .filter_map(Weak::upgrade)
        .map(|wire| wire.name.clone())
        .collect()
}

/// The open bus with this name.
pub(crate) fn find(name: &str) -> Option<Arc<Wire>> {
    let open = open_wires();
    open.iter()
        .filter_map(Weak::upgrade)
        .find(|wire| wire.name == name)
}

/// Frees the name of a bus.
pub(crate) fn release(wire: &Arc<Wire>) {
    open_wires().retain(|one| one.as_ptr() != Arc::as_ptr(wire));
}

/// A name that no open bus has.
pub(crate) fn free_name() -> String {
    format!("bench-{}", NUMBER.fetch_add(1, Ordering::Relaxed))
}

/// Opens the bus of a channel: that with its name, or else a new one with its devices.
///
/// # Errors
/// A device of the channel cannot be made, or the bus is open with another kind of time.
pub(crate) fn open(py: Python<'_>, channel: &str, time: Option<&str>) -> PyResult<Arc<Wire>> {
    let real = is_real(time)?;
    let (name, devices) = spec::split(channel);
    let name = name.unwrap_or(devices).trim();
    if let Some(wire) = find(name) {
        if real.is_some_and(|real| real != wire.lock().real.is_some()) {
            let other = if real == Some(true) {
                "virtual"
            } else {
                "real"
            };
            let why = format!(
                "the wire `{name}` is open in {other} time; open all its buses with the same `time`"
            );
            return Err(Fault::Value(why).into());
        }
        return Ok(wire);
    }
    let bare = channel == devices && !devices.trim().is_empty() && !spec::is_list(devices);
    let mut state = State::default();
    // A name that is neither a device nor a file is reported here.
    if bare || !devices.trim().is_empty() {
        spec::add(&mut state.bus, &mut state.names, devices)?;
    }
    state.start();
    add(py, name.to_owned(), state, real == Some(true), true)
}

/// Registers a bus by its name.
///
/// # Errors
/// An exception in Python.
pub(crate) fn add(
    py: Python<'_>,
    name: String,
    mut state: State,
    real: bool,
    of_channel: bool,
) -> PyResult<Arc<Wire>> {
    let mut epoch = 0.0;
    if real {
        state.real = Some(Clock::now());
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        epoch = now.map_or(0.0, |since| since.as_secs_f64());
    }
    let mut wire = Wire::new(py, name, epoch, state);
    wire.of_channel = of_channel;
    wire.notice_threads(py, true)?;
    let wire = Arc::new(wire);
    open_wires().push(Arc::downgrade(&wire));
    Ok(wire)
}

/// Whether `time` is `real`; `None`: either.
///
/// # Errors
/// It is another word.
pub(crate) fn is_real(time: Option<&str>) -> Result<Option<bool>, Fault> {
    match time {
        None => Ok(None),
        Some("virtual") => Ok(Some(false)),
        Some("real") => Ok(Some(true)),
        Some(other) => Err(Fault::value(format!(
            "time `{other}` is not known; write `virtual` or `real`"
        ))),
    }
}
