//! A state of a bench, to start from more than once.

use std::sync::{Mutex, PoisonError};

use od_sim::bus::Bus;
use pyo3::prelude::*;

use crate::cyclic::Cyclic;
use crate::faults::Fault;
use crate::state::State;
use crate::story::Story;

/// A state of a bench: its devices with all their state, the bus line, and the time.
/// `bench.snapshot()` makes one; `bench.restore(it)` restores it, and `odkit.Bench(it)` makes
/// another bench in this state.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Snapshot {
    bus: Mutex<Bus>,
    names: Vec<String>,
    cyclics: Vec<Cyclic>,
    story: Story,
}

/// The form of pickled snapshots and descriptions; another version of odkit may have another.
pub(crate) const FORM: &str = concat!("odkit ", env!("CARGO_PKG_VERSION"), " form 1");

/// Form that Python pickles: a function that restores the object, and its arguments.
pub(crate) type Pickled<'p, A> = PyResult<(Bound<'p, PyAny>, A)>;

/// Refuses what another version has pickled.
///
/// # Errors
/// `ValueError` with both versions.
pub(crate) fn is_own(form: &str, what: &str) -> Result<(), Fault> {
    if form == FORM {
        return Ok(());
    }
    Err(Fault::value(format!(
        "this {what} was pickled by `{form}`, and this is `{FORM}`; use the same version of odkit on all computers"
    )))
}

impl Snapshot {
    /// The state of a bench.
    pub(crate) fn of(state: &State) -> Self {
        let story = state.story.ended(state.now(), &state.due());
        Self {
            bus: Mutex::new(state.bus.clone()),
            names: state.names.clone(),
            cyclics: state.cyclics.clone(),
            story,
        }
    }

    /// The state after a script was played.
    pub(crate) fn made(bus: Bus, names: Vec<String>, story: Story) -> Self {
        Self {
            bus: Mutex::new(bus),
            names,
            cyclics: Vec::new(),
            story,
        }
    }

    /// Puts a bench into this state: its journal starts again, and received frames are dropped.
    pub(crate) fn restore(&self, state: &mut State) {
        let bus = self.bus.lock().unwrap_or_else(PoisonError::into_inner);
        state.bus = bus.clone();
        state.names.clone_from(&self.names);
        // Tasks that have ended since then stay ended.
        let is_there = |one: &&Cyclic| state.cyclics.iter().any(|own| own.id == one.id);
        let cyclics = self.cyclics.iter().filter(is_there).cloned().collect();
        state.cyclics = cyclics;
        state.forget();
        state.story = self.story.clone();
    }
}

#[pymethods]
impl Snapshot {
    /// The virtual time of the state in seconds.
    #[getter]
    fn now(&self) -> f64 {
        let bus = self.bus.lock().unwrap_or_else(PoisonError::into_inner);
        bus.now().as_micros() as f64 / 1e6
    }

    /// The script of what happened until then. Raises `ValueError` if a script has no line for something.
    fn script(&self) -> PyResult<String> {
        Ok(self.story.text().map_err(Fault::Value)?)
    }

    /// Pickles the script of the state and its names, with the version of odkit.
    fn __reduce__<'p>(&self, py: Python<'p>) -> Pickled<'p, (&'static str, String, Vec<String>)> {
        let restore = py.import("odkit._odkit")?.getattr("restore_snapshot")?;
        Ok((restore, (FORM, self.script()?, self.names.clone())))
    }

    fn __repr__(&self) -> String {
        format!(
            "<odkit.Snapshot of {} at {} s>",
            self.names.join(", "),
            self.now()
        )
    }
}
