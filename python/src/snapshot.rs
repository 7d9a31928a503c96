//! A state of a bench, to start from more than once.

use std::sync::{Mutex, PoisonError};

use od_bench::bus::Bus;
use pyo3::prelude::*;

use crate::cyclic::Cyclic;
use crate::faults::Fault;
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
    pub(crate) fn of(state: &State) -> Result<Self, Fault> {
        Ok(Self {
            bus: Mutex::new(copy(&state.bus)?),
            names: state.names.clone(),
            cyclics: state.cyclics.clone(),
        })
    }

    /// Puts a bench into this state: its journal starts again, and received frames are dropped.
    pub(crate) fn restore(&self, state: &mut State) -> Result<(), Fault> {
        let bus = self.bus.lock().unwrap_or_else(PoisonError::into_inner);
        state.bus = copy(&bus)?;
        state.names.clone_from(&self.names);
        // Tasks that have ended since then stay ended.
        let is_there = |one: &&Cyclic| state.cyclics.iter().any(|own| own.id == one.id);
        let cyclics = self.cyclics.iter().filter(is_there).cloned().collect();
        state.cyclics = cyclics;
        state.forget();
        Ok(())
    }
}

fn copy(bus: &Bus) -> Result<Bus, Fault> {
    bus.copy()
        .ok_or_else(|| Fault::value("a device of the bench cannot be copied"))
}

#[pymethods]
impl Snapshot {
    /// The virtual time of the state in seconds.
    #[getter]
    fn now(&self) -> f64 {
        let bus = self.bus.lock().unwrap_or_else(PoisonError::into_inner);
        bus.now().as_micros() as f64 / 1e6
    }
}
