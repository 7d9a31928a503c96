//! A link to a bus of a bench: waiting moves its time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use od_sim::logs::What;
use od_tools::Error;
use od_tools::link::{Heard, Link};
use od_wire::{Frame, Instant};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::party::Wait;
use crate::pass::pass;
use crate::wire::Wire;

/// A participant on a bus.
pub(crate) struct OnWire {
    pub(crate) wire: Arc<Wire>,
    id: u32,
    /// Says that a call has to end.
    stop: Arc<AtomicBool>,
    /// The exception that Python raised during the wait.
    pub(crate) raised: Option<PyErr>,
}

impl OnWire {
    /// Joins a bus.
    pub(crate) fn new(py: Python<'_>, wire: Arc<Wire>, stop: Arc<AtomicBool>) -> PyResult<Self> {
        let mut state = wire.enter(py)?;
        let id = state.listen(false);
        drop(state);
        Ok(Self {
            wire,
            id,
            stop,
            raised: None,
        })
    }

    fn taken(&mut self) -> Option<Heard> {
        let mut state = self.wire.lock();
        let own = state.listener(self.id)?;
        while let Some(heard) = own.queue.pop_front() {
            if let What::Frame(frame) = heard.what {
                return Some(Heard {
                    at: heard.at,
                    frame,
                });
            }
        }
        None
    }

    fn wait(&mut self, py: Python<'_>, until: Instant) -> PyResult<()> {
        let wait = Wait {
            port: Some(self.id),
            until: Some(until),
            ..Wait::default()
        };
        let (id, stop) = (self.id, &self.stop);
        pass(py, &self.wire, wait, false, &mut |state| {
            if stop.load(Ordering::Relaxed) {
                return Err(PyKeyboardInterrupt::new_err(()));
            }
            Ok(state.listener(id).is_none_or(|own| !own.queue.is_empty()))
        })?;
        Ok(())
    }

    fn send_now(&self, py: Python<'_>, frame: &Frame) -> PyResult<()> {
        let mut state = self.wire.enter(py)?;
        if let Some(clock) = state.clock() {
            while matches!(state.step(clock), crate::state::Step::Moved) {}
        }
        state.transmit(self.id, frame)?;
        state.wake();
        Ok(())
    }

    fn or_raised<T>(&mut self, done: PyResult<T>) -> Result<T, Error> {
        done.map_err(|error| {
            self.raised = Some(error);
            Error::Interrupted
        })
    }
}

impl Link for OnWire {
    fn now(&self) -> Instant {
        self.wire.lock().now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let sent = Python::attach(|py| self.send_now(py, frame));
        self.or_raised(sent)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            let heard = self.taken();
            if heard.is_some() || until <= self.now() {
                return Ok(heard);
            }
            let waited = Python::attach(|py| self.wait(py, until));
            self.or_raised(waited)?;
        }
    }
}

impl Drop for OnWire {
    fn drop(&mut self) {
        let mut state = self.wire.lock();
        state.changes += 1;
        state.listeners.retain(|one| one.id != self.id);
        state.wake();
    }
}
