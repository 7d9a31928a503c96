//! A state of a bench, to start from more than once.

use std::sync::{Mutex, PoisonError};

use od_sim::bus::Bus;
use pyo3::prelude::*;

use crate::cyclic::Cyclic;
use crate::state::State;

/// A state of a bench: its devices with all their state, the bus line, and the time.
/// `bench.snapshot()` makes one; `bench.restore(it)` restores it, and `odkit.Bench(it)` makes
/// another bench in this state.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Snapshot {
    bus: Mutex<Bus>,
    names: Vec<String>,
    cyclics: Vec<Cyclic>,
}

impl Snapshot {
    /// The state of a bench.
    pub(crate) fn of(state: &State) -> Self {
        Self {
            bus: Mutex::new(state.bus.clone()),
            names: state.names.clone(),
            cyclics: state.cyclics.clone(),
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

    fn __repr__(&self) -> String {
        format!(
            "<odkit.Snapshot of {} at {} s>",
            self.names.join(", "),
            self.now()
        )
    }
}
