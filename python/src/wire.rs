//! A bus that several threads and python-can buses share.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::faults::Fault;
use crate::party::{Found, Party};
use crate::state::State;

/// A bus with a name. Its lock is held with the interpreter attached, and never while a thread
/// waits, so that a fork finds it free.
pub(crate) struct Wire {
    /// The name by which python-can buses share it.
    pub(crate) name: String,
    /// Seconds since 1970 at which its time began, in real time; else 0.
    pub(crate) epoch: f64,
    /// A channel opened it, so it ends with the last python-can bus.
    pub(crate) of_channel: bool,
    state: Mutex<State>,
    /// The Python functions that make the frames of tasks, by their numbers.
    makers: Py<PyDict>,
}

impl Wire {
    pub(crate) fn new(py: Python<'_>, name: String, epoch: f64, state: State) -> Self {
        Self {
            of_channel: false,
            name,
            epoch,
            state: Mutex::new(state),
            makers: PyDict::new(py).unbind(),
        }
    }

    /// State of the threads with these numbers, as `odkit._who.waits` reports it.
    ///
    /// # Errors
    /// An exception in Python.
    pub(crate) fn look(py: Python<'_>, threads: &[u64]) -> PyResult<Vec<Found>> {
        static WHO: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let load = || PyResult::Ok(py.import("odkit._who")?.getattr("waits")?.unbind());
        let who = WHO.get_or_try_init(py, load)?;
        who.call1(py, (threads.to_vec(),))?.extract(py)
    }

    /// The function that makes the frames of a task.
    pub(crate) fn maker(&self, py: Python<'_>, task: u32) -> Option<Py<PyAny>> {
        self.makers.bind(py).get_item(task).ok()?.map(Bound::unbind)
    }

    /// Sets the function that makes the frames of a task; `None` removes it.
    pub(crate) fn set_maker(
        &self,
        py: Python<'_>,
        task: u32,
        maker: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let makers = self.makers.bind(py);
        match maker {
            Some(maker) => makers.set_item(task, maker),
            None if makers.contains(task)? => makers.del_item(task),
            None => Ok(()),
        }
    }

    /// Its state, to read.
    pub(crate) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Its state for a thread that takes part from now on.
    ///
    /// # Errors
    /// Python does not say which thread this is.
    pub(crate) fn enter(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, State>> {
        let id = thread::current().id();
        let mut state = self.lock();
        if state.touch(id) {
            return Ok(state);
        }
        drop(state);
        let party = Party::this(py.import("odkit._who")?.call_method0("this")?.extract()?);
        let mut state = self.lock();
        state.parties.retain(|one| one.native != party.native);
        state.parties.push(party);
        Ok(state)
    }

    /// Registers the threads that were started since the last call; from now on they take part. Returns
    /// whether there is one. `is_first`: all existing threads existed before.
    ///
    /// # Errors
    /// An exception in Python.
    pub(crate) fn notice_threads(&self, py: Python<'_>, is_first: bool) -> PyResult<bool> {
        let (active, limbo) = threads(py)?;
        if !limbo.is_empty() && !is_first {
            return Ok(true);
        }
        let mut natives = Vec::with_capacity(4);
        for thread in active.values() {
            natives.push(
                thread
                    .getattr(intern!(py, "_native_id"))?
                    .extract::<u64>()?,
            );
        }
        let mut state = self.lock();
        let known = std::mem::replace(&mut state.threads, natives.clone());
        natives.retain(|one| !known.contains(one));
        if natives.is_empty() || is_first {
            return Ok(false);
        }
        drop(state);
        let all: Vec<(u64, u64, bool)> = py
            .import("odkit._who")?
            .call_method0("threads")?
            .extract()?;
        let mut state = self.lock();
        for (ident, native, daemon) in all {
            let takes_part = state.parties.iter().any(|one| one.native == native);
            if natives.contains(&native) && !takes_part {
                state.parties.push(Party::new(ident, native, daemon));
            }
        }
        Ok(true)
    }

    /// Seconds of a moment, as in timestamps.
    pub(crate) fn seconds(&self, at: od_wire::Instant) -> f64 {
        self.epoch + at.as_micros() as f64 / 1e6
    }
}

/// The threads of `threading`, and those that are just starting.
fn threads(py: Python<'_>) -> PyResult<(&Bound<'_, PyDict>, &Bound<'_, PyDict>)> {
    static THREADS: PyOnceLock<(Py<PyDict>, Py<PyDict>)> = PyOnceLock::new();
    let load = || {
        let threading = py.import("threading")?;
        let dict =
            |name: &str| PyResult::Ok(threading.getattr(name)?.cast_into::<PyDict>()?.unbind());
        PyResult::Ok((dict("_active")?, dict("_limbo")?))
    };
    let (active, limbo) = THREADS.get_or_try_init(py, load)?;
    Ok((active.bind(py), limbo.bind(py)))
}

/// Microseconds of a number of seconds.
///
/// # Errors
/// It is negative or not a number.
pub(crate) fn micros(seconds: f64, what: &str) -> Result<u64, Fault> {
    match seconds {
        // A number that is too large becomes the maximum; 2^63 µs are 292,000 years.
        _ if seconds >= 0.0 => Ok((seconds * 1e6).round().min(9e18) as u64),
        _ => Err(Fault::value(format!(
            "{what} is {seconds}; it must be 0 s or more"
        ))),
    }
}
