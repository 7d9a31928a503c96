//! A link over any bus of python-can.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant as Clock;

use od_sim::journal::frame;
use od_tools::Error;
use od_tools::link::{Heard, Link};
use od_wire::{Frame, Instant};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Maximum wait in seconds: some buses handle no signals while they wait, and none waits for years.
const SLICE: f64 = 0.04;

/// A bus of python-can, with the clock of the computer.
pub(crate) struct OnBus {
    bus: Py<PyAny>,
    /// Says that a call has to end.
    stop: Arc<AtomicBool>,
    began: Clock,
    /// The exception that Python raised.
    pub(crate) raised: Option<PyErr>,
}

impl OnBus {
    pub(crate) fn new(bus: Py<PyAny>, stop: Arc<AtomicBool>) -> Self {
        Self {
            bus,
            stop,
            began: Clock::now(),
            raised: None,
        }
    }

    fn send_now(&self, py: Python<'_>, frame: &Frame) -> PyResult<()> {
        let message = PyDict::new(py);
        message.set_item("arbitration_id", frame.id().raw())?;
        message.set_item("is_extended_id", frame.id().is_extended())?;
        message.set_item("is_remote_frame", frame.is_remote())?;
        if frame.is_remote() {
            message.set_item("dlc", frame.dlc())?
        } else {
            message.set_item("data", frame.data())?
        }
        let message = py
            .import("can")?
            .getattr("Message")?
            .call((), Some(&message))?;
        self.bus.call_method1(py, "send", (message,))?;
        Ok(())
    }

    /// The next data frame or remote frame.
    fn taken(&self, py: Python<'_>, until: Instant) -> PyResult<Option<Heard>> {
        loop {
            let left = until.micros_since(self.now().min(until)) as f64 / 1e6;
            let message = self.bus.bind(py).call_method1("recv", (left.min(SLICE),))?;
            if message.is_none() {
                if self.now() >= until {
                    return Ok(None);
                }
                self.look(py)?;
                continue;
            }
            let flag = |name: &str| message.getattr(name)?.is_truthy();
            if flag("is_error_frame")? || flag("is_fd")? {
                continue;
            }
            let id: u32 = message.getattr("arbitration_id")?.extract()?;
            let is_remote = flag("is_remote_frame")?;
            let data: Vec<u8> = if is_remote {
                vec![0; message.getattr("dlc")?.extract()?]
            } else {
                message.getattr("data")?.extract()?
            };
            if let Some(frame) = frame(id, &data, flag("is_extended_id")?, is_remote) {
                let at = self.now();
                return Ok(Some(Heard { at, frame }));
            }
        }
    }

    /// Checks for signals, and for the end of the call.
    fn look(&self, py: Python<'_>) -> PyResult<()> {
        py.check_signals()?;
        if self.stop.load(Ordering::Relaxed) {
            return Err(PyKeyboardInterrupt::new_err(()));
        }
        Ok(())
    }

    fn or_raised<T>(&mut self, done: PyResult<T>) -> Result<T, Error> {
        done.map_err(|error| {
            self.raised = Some(error);
            Error::Interrupted
        })
    }
}

impl Link for OnBus {
    fn now(&self) -> Instant {
        let micros = self.began.elapsed().as_micros();
        Instant::from_micros(u64::try_from(micros).unwrap_or(u64::MAX))
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let sent = Python::attach(|py| self.send_now(py, frame));
        self.or_raised(sent)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let taken = Python::attach(|py| self.taken(py, until));
        self.or_raised(taken)
    }
}
