//! The open buses, by name.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Instant as Clock, SystemTime, UNIX_EPOCH};

use pyo3::prelude::*;

use crate::faults::Fault;
use crate::spec;
use crate::state::State;
use crate::time::Time;
use crate::wire::{Wire, waits};

static WIRES: Mutex<Vec<Weak<Wire>>> = Mutex::new(Vec::new());
static NUMBER: AtomicU32 = AtomicU32::new(1);

fn open_wires() -> MutexGuard<'static, Vec<Weak<Wire>>> {
    let mut wires = WIRES.lock().unwrap_or_else(PoisonError::into_inner);
    wires.retain(|wire| wire.strong_count() > 0);
    wires
}

/// The buses that exist.
pub(crate) fn all() -> Vec<Arc<Wire>> {
    open_wires().iter().filter_map(Weak::upgrade).collect()
}

/// Names of the open buses.
#[pyfunction]
pub(crate) fn wires() -> Vec<String> {
    let all = all();
    let named = all.iter().filter(|wire| wire.has_name());
    named.map(|wire| wire.name.clone()).collect()
}

/// The open bus with this name.
pub(crate) fn find(name: &str) -> Option<Arc<Wire>> {
    all()
        .into_iter()
        .find(|wire| wire.has_name() && wire.name == name)
}

/// A name that no open bus has.
pub(crate) fn free_name() -> String {
    format!("bench-{}", NUMBER.fetch_add(1, Ordering::Relaxed))
}

/// Opens the bus of a channel: that with its name, or else a new one with its devices.
///
/// # Errors
/// A device of the channel cannot be made, or the bus is open with another kind of time.
pub(crate) fn open(
    py: Python<'_>,
    channel: &str,
    time: Option<Time>,
    pace: Option<f64>,
) -> PyResult<Arc<Wire>> {
    let (name, devices) = spec::split(channel);
    let name = name.unwrap_or(devices).trim();
    if let Some(wire) = find(name) {
        let own = wire.lock().time();
        if time.is_some_and(|time| time != own) {
            let why = format!(
                "the wire `{name}` is open in {} time; open all its buses with the same `time`",
                own.name()
            );
            return Err(Fault::Value(why).into());
        }
        return Ok(wire);
    }
    let bare = channel == devices && !devices.trim().is_empty() && !spec::is_list(devices);
    let mut state = State::default();
    state.pace = pace.unwrap_or(state.pace);
    // A name that is neither a device nor a file is reported here.
    if bare || !devices.trim().is_empty() {
        let added = spec::add(&mut state.bus, &mut state.names, devices)?;
        for (place, line) in added {
            state.story.device(line, place);
        }
    }
    state.start();
    add(py, name.to_owned(), state, time.unwrap_or_default(), true)
}

/// Registers a bus by its name.
///
/// # Errors
/// An exception in Python.
pub(crate) fn add(
    py: Python<'_>,
    name: String,
    mut state: State,
    time: Time,
    of_channel: bool,
) -> PyResult<Arc<Wire>> {
    let mut epoch = 0.0;
    state.strict = time == Time::Strict;
    if time == Time::Real {
        state.real = Some(Clock::now());
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        epoch = now.map_or(0.0, |since| since.as_secs_f64());
    } else {
        waits(py)?.call_method0("install")?;
    }
    let wire = Wire::new(py, name, (epoch, of_channel), state);
    // The thread that opens it is the first that takes part.
    drop(wire.enter(py)?);
    open_wires().push(Arc::downgrade(&wire));
    Ok(wire)
}
