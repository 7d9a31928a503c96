//! A bus that several threads and python-can buses share.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread;
use std::time::Instant as Clock;

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::faults::Fault;
use crate::party::{Party, Seen, compete};
use crate::state::State;

/// A bus with a name. A thread holds its lock only with the interpreter attached, and never while it waits, so that a
/// fork finds it free. The only thread on a bus may hold it without the interpreter.
pub(crate) struct Wire {
    /// The name by which python-can buses share it.
    pub(crate) name: String,
    /// A number that no other bus has.
    pub(crate) number: usize,
    /// Seconds since 1970 at which its time began, in real time; else 0.
    pub(crate) epoch: f64,
    /// A channel opened it, so it ends with the last python-can bus.
    pub(crate) of_channel: bool,
    state: Mutex<State>,
    me: Weak<Self>,
    /// Another bus can have its name.
    is_released: AtomicBool,
    /// The Python functions that make the frames of tasks, by their numbers.
    makers: Py<PyDict>,
}

impl Wire {
    pub(crate) fn new(
        py: Python<'_>,
        name: String,
        (epoch, of_channel): (f64, bool),
        state: State,
    ) -> Arc<Self> {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        Arc::new_cyclic(|me| Self {
            number: NUMBER.fetch_add(1, Ordering::Relaxed),
            of_channel,
            name,
            epoch,
            state: Mutex::new(state),
            me: me.clone(),
            is_released: AtomicBool::new(false),
            makers: PyDict::new(py).unbind(),
        })
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

    /// Returns whether python-can buses can share it by its name.
    pub(crate) fn has_name(&self) -> bool {
        !self.is_released.load(Ordering::Relaxed)
    }

    /// Frees its name.
    pub(crate) fn release(&self) {
        self.is_released.store(true, Ordering::Relaxed);
    }

    /// Returns whether a program can still use it: it has its name, or a bus of python-can.
    pub(crate) fn is_open(&self) -> bool {
        self.has_name() || !self.lock().listeners.is_empty()
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
        let this = waits(py)?.call_method0(intern!(py, "this"))?.extract()?;
        let party = Party::new(Some(thread::current()), this);
        OWN.with_borrow_mut(|own| {
            own.retain(|one| one.strong_count() > 0);
            own.push(self.me.clone());
        });
        let mut state = self.lock();
        // The number of a thread that has ended is used again.
        state.parties.retain(|one| one.ident != party.ident);
        state.parties.push(party);
        Ok(state)
    }

    /// Returns whether a thread that takes part runs. Forgets those that have ended. If all that run wait for
    /// something that Python does not report, time follows the clock from now on.
    ///
    /// # Errors
    /// `RuntimeError` if the bus forbids it; an exception in Python.
    pub(crate) fn look(&self, py: Python<'_>) -> PyResult<bool> {
        let id = thread::current().id();
        let mut asked = Vec::new();
        for party in &self.lock().parties {
            if party.thread.is_none() {
                return Ok(true);
            }
            let target = party.target.as_ref().map(|target| target.clone_ref(py));
            if party.wait.is_some() && target.is_none() || party.is(id) && target.is_none() {
                continue;
            }
            asked.push((
                party.ident,
                party.object.clone_ref(py),
                party.processor,
                target,
            ));
        }
        let known: Vec<(bool, Option<f64>, bool)> = waits(py)?
            .call_method1(
                intern!(py, "look"),
                (asked
                    .iter()
                    .map(|(_, object, processor, target)| (object, processor, target))
                    .collect::<Vec<_>>(),),
            )?
            .extract()?;
        let mut state = self.lock();
        let (mut runs, mut asleep, mut computes, mut silent) = (false, None, None, Vec::new());
        for ((ident, object, ..), (lives, time, is_awaited)) in asked.iter().zip(known) {
            let at = state.parties.iter().position(|party| party.ident == *ident);
            let Some(at) = at else { continue };
            let party = &mut state.parties[at];
            if party.wait.is_some() || party.is(id) {
                // The thread that it waits for has ended, so it continues.
                runs |= party.target.is_some() && !is_awaited;
                continue;
            }
            let seen = party.look(time);
            party.is_asleep = seen == Seen::Asleep;
            if !lives || (party.is_asleep && !party.is_known) {
                state.parties.remove(at);
                // A thread that waited for its end may have been asked before it ended.
                runs = true;
                continue;
            }
            match seen {
                Seen::Runs => {}
                Seen::Computes => computes = Some(object),
                Seen::Silent => silent.push(*ident),
                Seen::Asleep => asleep = Some(object),
            }
            runs |= seen != Seen::Asleep;
        }
        if !silent.is_empty() {
            let changes = state.changes;
            drop(state);
            compete(py)?;
            let mut state = self.lock();
            if state.changes == changes {
                let parties = state.parties.iter_mut();
                let silent = parties.filter(|party| silent.contains(&party.ident));
                silent.for_each(|party| party.has_lost = true);
            }
            return Ok(true);
        }
        if asleep.is_none() {
            state.follows = None;
        }
        if let Some(object) = computes.filter(|_| !state.warned_of_computing) {
            state.warned_of_computing = true;
            drop(state);
            waits(py)?.call_method1(intern!(py, "report_long"), (object,))?;
            return Ok(runs);
        }
        let Some(asleep) = asleep.filter(|_| !runs && state.follows.is_none()) else {
            return Ok(runs);
        };
        let now = state.now();
        state.follows = Some((Clock::now(), now));
        let (strict, warned) = (
            state.strict,
            std::mem::replace(&mut state.warned_of_clock, true),
        );
        drop(state);
        if strict || !warned {
            waits(py)?.call_method1(intern!(py, "report"), (asleep, strict))?;
        }
        Ok(true)
    }

    /// Seconds of a moment, as in timestamps.
    pub(crate) fn seconds(&self, at: od_wire::Instant) -> f64 {
        self.epoch + at.as_micros() as f64 / 1e6
    }
}

thread_local! {
    /// The buses on which this thread takes part.
    static OWN: RefCell<Vec<Weak<Wire>>> = const { RefCell::new(Vec::new()) };
}

/// The open buses in virtual time on which this thread takes part.
pub(crate) fn own() -> Vec<Arc<Wire>> {
    let id = thread::current().id();
    let takes_part = |wire: &Arc<Wire>| {
        let is_open = wire.is_open();
        let state = wire.lock();
        is_open && state.real.is_none() && state.parties.iter().any(|party| party.is(id))
    };
    OWN.with_borrow(|own| {
        own.iter()
            .filter_map(Weak::upgrade)
            .filter(takes_part)
            .collect()
    })
}

/// Returns whether this thread has ever taken part on a bus that exists, without taking a lock.
pub(crate) fn is_known() -> bool {
    OWN.with_borrow(|own| !own.is_empty())
}

/// The other buses in virtual time on which this thread takes part.
pub(crate) fn others(wire: &Wire) -> Vec<Arc<Wire>> {
    if OWN.with_borrow(|own| own.len() < 2) {
        return Vec::new();
    }
    let mut others = own();
    others.retain(|other| other.number != wire.number);
    others
}

/// The Python module that reports waits of Python.
///
/// # Errors
/// An exception in Python.
pub(crate) fn waits(py: Python<'_>) -> PyResult<&Bound<'_, PyModule>> {
    static WAITS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let load = || PyResult::Ok(py.import("odkit._waits")?.unbind());
    Ok(WAITS.get_or_try_init(py, load)?.bind(py))
}

/// Python makes the frame of a cyclic task.
///
/// # Errors
/// An exception in Python.
pub(crate) fn call(py: Python<'_>, wire: &Wire, task: u32, place: usize) -> PyResult<()> {
    let Some(maker) = wire.maker(py, task) else {
        return Ok(());
    };
    let frame = maker
        .call1(py, (place,))?
        .extract::<crate::value::Parts>(py)?
        .frame()?;
    let mut state = wire.lock();
    let port = state
        .cyclics
        .iter()
        .find(|one| one.id == task)
        .map(|one| one.port);
    if let Some(port) = port {
        // A frame that the line does not accept is lost, like that of a timer.
        drop(state.transmit(port, &frame));
        state.wake();
    }
    Ok(())
}

/// A number that is neither infinite nor `nan`.
///
/// # Errors
/// It is.
pub(crate) fn finite(number: f64, what: &str) -> Result<f64, Fault> {
    if number.is_finite() {
        return Ok(number);
    }
    Err(Fault::value(format!(
        "{what} must be a finite number, not {number}"
    )))
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
