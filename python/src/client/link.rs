//! The link of a client: a bench, a bus of python-can, or a real one by its name.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use od_tools::Error;
use od_tools::conform::rig::Rig;
use od_tools::link::{Heard, Link};
use od_tools::links;
use od_wire::{Frame, Instant};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::bench::Bench;
use crate::client::errors::raised;
use crate::client::on_bus::OnBus;
use crate::client::on_wire::OnWire;
use crate::pass::{NAP, look, sleep};

/// Maximum wait before signals such as Ctrl-C are handled.
const SLICE: Duration = Duration::from_millis(40);

/// Says that a call has to end, also while it waits.
pub(crate) type Stop = Arc<AtomicBool>;

/// An open link.
pub(crate) enum Line {
    Wire(OnWire),
    Bus(OnBus),
    /// A link by name; and the exception that Python raised during a wait.
    Real(Box<dyn Link + Send>, Option<PyErr>, Stop),
}

impl Line {
    /// Opens the link that a caller names.
    ///
    /// # Errors
    /// It cannot be opened.
    pub(crate) fn open(link: &Bound<'_, PyAny>, stop: &Stop) -> PyResult<Self> {
        let py = link.py();
        if let Ok(bench) = link.cast::<Bench>() {
            let wire = Arc::clone(&bench.get().wire);
            return Ok(Self::Wire(OnWire::new(py, wire, Arc::clone(stop))?));
        }
        if let Ok(name) = link.extract::<String>() {
            if let Some(devices) = name.strip_prefix("bench:") {
                let bench = py.get_type::<Bench>().call1((devices,))?;
                return Self::open(&bench, stop);
            }
            return Ok(Self::Real(open_by_name(py, name)?, None, Arc::clone(stop)));
        }
        if let Ok(bench) = link.getattr("bench")
            && bench.is_instance_of::<Bench>()
        {
            return Self::open(&bench, stop);
        }
        Ok(Self::Bus(OnBus::new(
            link.clone().unbind(),
            Arc::clone(stop),
        )))
    }

    /// The exception of a fault: the one that Python raised during the wait, if any.
    pub(crate) fn raised(&mut self, fault: Error) -> PyErr {
        let own = match self {
            Self::Wire(one) => one.raised.take(),
            Self::Bus(one) => one.raised.take(),
            Self::Real(_, error, _) => error.take(),
        };
        own.unwrap_or_else(|| raised(fault))
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wire(one) => write!(f, "on {}", one.wire.name),
            Self::Bus(_) => f.write_str("on a bus of python-can"),
            Self::Real(..) => f.write_str("on a link"),
        }
    }
}

/// Opens a real link. Without a response this takes seconds, so a thread of its own does it; Ctrl-C ends the wait for this
/// thread.
fn open_by_name(py: Python<'_>, name: String) -> PyResult<Box<dyn Link + Send>> {
    let opening = thread::spawn(move || links::open_between_threads(&name, None));
    while !opening.is_finished() {
        sleep(py, NAP)?;
    }
    let opened = opening.join();
    let opened = opened.map_err(|_| PyOSError::new_err("the link cannot be opened"))?;
    opened.map_err(raised)
}

impl Link for Line {
    fn now(&self) -> Instant {
        match self {
            Self::Wire(one) => one.now(),
            Self::Bus(one) => one.now(),
            Self::Real(one, ..) => one.now(),
        }
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        match self {
            Self::Wire(one) => one.send(frame),
            Self::Bus(one) => one.send(frame),
            Self::Real(one, error, _) => Python::attach(|py| {
                one.begin_send(frame)?;
                // It takes up to 2 s if the other side does not read.
                while !py.detach(|| one.finish_send(one.now() + SLICE))? {
                    if let Err(why) = look(py) {
                        *error = Some(why);
                        return Err(Error::Interrupted);
                    }
                }
                Ok(())
            }),
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let (link, error, stop) = match self {
            Self::Wire(one) => return one.receive(until),
            Self::Bus(one) => return one.receive(until),
            Self::Real(link, error, stop) => (link, error, stop),
        };
        Python::attach(|py| {
            loop {
                // Also if frames come all the time.
                if let Err(why) = look(py) {
                    *error = Some(why);
                    return Err(Error::Interrupted);
                }
                if stop.load(Ordering::Relaxed) {
                    return Err(Error::Interrupted);
                }
                let slice = link.now() + SLICE;
                let heard = py.detach(|| link.receive(until.min(slice)))?;
                if heard.is_some() || link.now() >= until {
                    return Ok(heard);
                }
            }
        })
    }
}

impl Rig for Line {
    fn has_power(&self) -> bool {
        matches!(self, Self::Wire(_))
    }

    fn power(&mut self, on: bool) -> Result<(), Error> {
        if let Self::Wire(one) = self {
            let mut state = one.wire.lock();
            for device in 0..state.bus.devices().len() {
                state.tell(Some(device), if on { "power on" } else { "power off" });
                state.bus.set_power(device, on);
            }
            state.collect();
            state.wake();
        }
        Ok(())
    }

    fn slack(&self) -> u64 {
        match self {
            Self::Wire(one) if one.wire.lock().real.is_none() => 0,
            _ => 10_000,
        }
    }
}
