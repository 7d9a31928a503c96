//! The waits of Python, as `odkit/_waits.py` reports them.

use std::sync::atomic::{AtomicU32, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::Instant as Clock;

use od_wire::Instant;
use pyo3::prelude::*;

use crate::party::{Party, Wait};
use crate::pass::{Moved, NAP, Pass, length};
use crate::registry::all;
use crate::wire::{self, Wire};

/// Returns whether this thread takes part on a bus in virtual time.
#[pyfunction]
pub(crate) fn takes_part() -> bool {
    wire::is_known() && !wire::own().is_empty()
}

/// The time in microseconds of the newest bus on which this thread takes part, or else of the oldest one, and a number
/// of that bus.
#[pyfunction]
pub(crate) fn moment() -> Option<(usize, u64)> {
    let is_virtual = |wire: &Arc<Wire>| wire.lock().real.is_none();
    let wire = wire::own().pop();
    let wire = wire.or_else(|| all().into_iter().find(is_virtual))?;
    let now = wire.lock().now().as_micros();
    Some((wire.number, now))
}

/// Whether the waits of Python take no time on the clock; counts how often that was wanted.
static PATCHED: AtomicUsize = AtomicUsize::new(0);

/// Returns whether the waits of Python take no time on the clock.
fn is_patched() -> bool {
    PATCHED.load(Ordering::Relaxed) > 0
}

/// Begins or ends `patch_time`.
#[pyfunction]
pub(crate) fn patch(on: bool) {
    if !on {
        PATCHED.fetch_sub(1, Ordering::Relaxed);
        return;
    }
    PATCHED.fetch_add(1, Ordering::Relaxed);
    for wire in all() {
        let mut state = wire.lock();
        let waits = state
            .parties
            .iter_mut()
            .filter_map(|party| party.wait.as_mut());
        waits.for_each(|wait| wait.paced = None);
    }
}

/// A wait of Python by a thread that takes part on buses: at most `timeout` seconds. `paced`: it takes as long on the
/// clock as on the bus. Python itself does the waiting, in pauses of the lengths that an iteration yields: a program that
/// ends would stop a thread inside this module, and Python handles its signals.
///
/// It ends when Python drops it. This runs no Python code, in which Ctrl-C would be lost.
#[pyclass(frozen, module = "odkit._odkit")]
pub(crate) struct Waiting {
    waits: Mutex<Vec<Waited>>,
    idle: AtomicU32,
    thread: ThreadId,
}

/// A bus, the wait on it, and its time at the start of the wait.
type Waited = (Arc<Wire>, Wait, Instant);

#[pymethods]
impl Waiting {
    /// `target` is a weak reference to the thread for whose end it waits.
    #[new]
    #[pyo3(signature = (timeout, paced=true, target=None))]
    fn new(py: Python<'_>, timeout: Option<f64>, paced: bool, target: Option<Py<PyAny>>) -> Self {
        let id = thread::current().id();
        // A call takes no time, so 0.3 s are left of 0.3 s.
        let micros =
            timeout.map(|seconds| (seconds * 1e3 - 1e-3).ceil().clamp(0.0, 9e15) as u64 * 1000);
        let mut waits = Vec::new();
        for wire in wire::own() {
            let mut state = wire.lock();
            state.touch(id);
            let now = state.now();
            let wait = Wait {
                until: micros.map(|micros| now.plus_micros(micros)),
                paced: (paced && !is_patched()).then(|| (Clock::now(), now)),
                ..Wait::default()
            };
            if let Some(own) = state.parties.iter_mut().find(|party| party.is(id)) {
                own.target = target.as_ref().map(|target| target.clone_ref(py));
            }
            drop(state);
            waits.push((wire, wait, now));
        }
        Self {
            waits: Mutex::new(waits),
            idle: AtomicU32::new(0),
            thread: id,
        }
    }

    fn __iter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    /// Moves time if this thread may. Returns how long to wait in seconds, or `None` if the wait is over.
    fn __next__(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        let taken = || self.waits.lock().unwrap_or_else(PoisonError::into_inner);
        let mut waits = std::mem::take(&mut *taken());
        let paused = self.pause_on(py, &mut waits);
        *taken() = waits;
        paused
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        let waits = self.waits.get_mut().unwrap_or_else(PoisonError::into_inner);
        for (wire, ..) in waits {
            wire.lock().leave(self.thread);
        }
    }
}

impl Waiting {
    fn pause_on(&self, py: Python<'_>, waits: &mut Vec<Waited>) -> PyResult<Option<f64>> {
        let id = thread::current().id();
        let is_closed = |(wire, ..): &Waited| !wire.is_open();
        for (wire, ..) in waits.iter().filter(|one| is_closed(one)) {
            // The others on a closed bus do not wait for this thread.
            wire.lock().parties.retain(|party| !party.is(id));
        }
        if waits.iter().all(is_closed) {
            return Ok(waits.first_mut().and_then(rest));
        }
        waits.retain(|one| !is_closed(one));
        let idle = self.idle.load(Ordering::Relaxed);
        let (mut moved, mut pause, mut is_over) = (false, NAP, true);
        // The time of a bus does not move while one of its threads waits on another bus.
        let stands = |wire: &Wire| wire.lock().parties.iter().any(|party| party.elsewhere);
        let all_stand = waits.iter().all(|(wire, ..)| stands(wire));
        for (wire, wait, began) in waits {
            if !all_stand && stands(wire) {
                continue;
            }
            let mut pass = Pass::new(wire, false);
            pass.idle = idle;
            let mut state = wire.lock();
            state.begin(id, *wait);
            let is_late = wait.until.is_some_and(|until| until <= state.now());
            let is_next = is_late && pass.is_next(&mut state, *wait, *began);
            if is_next {
                continue;
            }
            is_over = false;
            drop(state);
            if is_late {
                pass.forget_ended(py)?;
                continue;
            }
            match pass.move_time(py, *wait)? {
                Moved::Yes => moved = true,
                Moved::No(most) => pause = pause.min(most),
            }
        }
        if is_over {
            return Ok(None);
        }
        if moved {
            self.idle.store(0, Ordering::Relaxed);
            return Ok(Some(0.0));
        }
        self.idle.store(idle.saturating_add(1), Ordering::Relaxed);
        Ok(Some(length(idle, pause).as_secs_f64()))
    }
}

/// The pause of a wait whose buses were all closed during it: its rest takes its time on the clock.
fn rest((wire, wait, _): &mut Waited) -> Option<f64> {
    let state = wire.lock();
    let start = *wait.paced.get_or_insert((Clock::now(), state.now()));
    let left = match wait.until {
        Some(until) => state.left(start, until)?,
        None => NAP,
    };
    Some(left.min(NAP).as_secs_f64())
}

/// A number that no thread has.
fn child_number() -> u64 {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    u64::MAX - NUMBER.fetch_add(1, Ordering::Relaxed)
}

/// A thread was woken: it runs from now on, even before the system lets it.
#[pyfunction]
pub(crate) fn wake(ident: u64) {
    for wire in all() {
        let mut state = wire.lock();
        if let Some(party) = state.parties.iter_mut().find(|party| party.ident == ident) {
            party.wait = None;
            state.changes += 1;
        }
    }
}

/// A thread that is about to start takes part on the buses of the thread that starts it.
#[pyclass(frozen, module = "odkit._odkit")]
pub(crate) struct Child {
    wires: Vec<Arc<Wire>>,
    number: u64,
}

#[pymethods]
impl Child {
    #[new]
    fn new(py: Python<'_>, object: Py<PyAny>) -> Self {
        let wires = wire::own();
        let number = child_number();
        for wire in &wires {
            let mut state = wire.lock();
            let number = (number, object.clone_ref(py), None);
            state.parties.push(Party::new(None, number));
        }
        Self { wires, number }
    }

    /// The started thread runs.
    fn begin(&self, py: Python<'_>) -> PyResult<()> {
        for wire in &self.wires {
            let mut state = wire.enter(py)?;
            let id = thread::current().id();
            let own = state.parties.iter_mut().find(|party| party.is(id));
            own.into_iter().for_each(|own| own.is_known = false);
        }
        self.end();
        Ok(())
    }

    /// The thread did not start.
    fn end(&self) {
        for wire in &self.wires {
            let mut state = wire.lock();
            state.parties.retain(|party| party.ident != self.number);
            state.changes += 1;
            state.wake();
        }
    }
}
