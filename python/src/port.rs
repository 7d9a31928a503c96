//! A bus of python-can.

use std::sync::{Arc, Mutex, PoisonError};

use od_sim::line::ErrorState;
use od_sim::logs::What;
use od_wire::Frame;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyString, PyTuple};

use crate::bench::Bench;
use crate::cyclic::Cyclic;
use crate::faults::Fault;
use crate::filter::Filter;
use crate::party::Wait;
use crate::pass::pass;
use crate::registry;
use crate::state::Heard;
use crate::time::{self as times, Time};
use crate::value::Parts;
use crate::wire::{Wire, micros};

/// CAN-ID of an error frame of python-can; its data has the reason, as in SocketCAN.
const PROTOCOL_ERROR: u32 = 0x08;
const ERROR_DATA: [u8; 8] = [0, 0, 4, 0, 0, 0, 0, 0];

/// A participant on a bus; `odkit.bus.OdkitBus` is its Python half.
#[pyclass(frozen, module = "odkit._odkit")]
pub(crate) struct Port {
    id: u32,
    /// `None` once it is closed.
    wire: Mutex<Option<Arc<Wire>>>,
    channel: Py<PyString>,
}

impl Port {
    fn wire(&self) -> Result<Arc<Wire>, Fault> {
        let wire = self.wire.lock().unwrap_or_else(PoisonError::into_inner);
        wire.clone()
            .ok_or_else(|| Fault::system("the bus is closed"))
    }
}

#[pymethods]
impl Port {
    #[new]
    #[pyo3(signature = (channel, time=None, own=false, bitrate=None, bench=None, pace=None))]
    fn new(
        py: Python<'_>,
        channel: &str,
        time: Option<&str>,
        own: bool,
        bitrate: Option<u32>,
        bench: Option<&Bench>,
        pace: Option<f64>,
    ) -> PyResult<Self> {
        let time = time.map(Time::parse).transpose()?;
        let pace = pace.map(times::pace).transpose()?;
        let wire = match bench {
            Some(bench) => Arc::clone(&bench.wire),
            None => registry::open(py, channel, time, pace)?,
        };
        let mut state = wire.enter(py)?;
        let id = state.listen(own);
        if let Some(rate) = bitrate.and_then(|rate| u16::try_from(rate / 1000).ok()) {
            state.tell(None, &format!("bus bitrate {rate}"));
            state.bus.set_bit_rate(Some(rate));
            state.bus.line.bit_rate = Some(rate);
        }
        // The first bus receives the boot-up messages of its devices.
        state.collect();
        drop(state);
        Ok(Self {
            id,
            wire: Mutex::new(Some(wire)),
            channel: PyString::new(py, channel).unbind(),
        })
    }

    /// Sends a frame: CAN-ID, extended, remote, length of a remote frame, data.
    fn send(&self, py: Python<'_>, frame: Parts) -> PyResult<()> {
        let frame = frame.frame()?;
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        if let Some(clock) = state.clock() {
            // Calls of Python are handled by the next thread that waits.
            while matches!(state.step(clock), crate::state::Step::Moved) {}
        }
        state.transmit(self.id, &frame)?;
        state.wake();
        Ok(())
    }

    /// The next frame as the arguments of `can.Message`, or `None` after the time-out.
    #[pyo3(signature = (timeout=None))]
    fn recv<'p>(
        &self,
        py: Python<'p>,
        timeout: Option<f64>,
    ) -> PyResult<Option<Bound<'p, PyTuple>>> {
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        let is_alone = state.parties.len() == 1 || state.real.is_some();
        // A reader that requests the next frame may have woken another thread with the last one.
        let mut in_turn = state.parties.len() > 2;
        let mut heard = None;
        if let Some(own) = state.listener(self.id) {
            in_turn |= !own.queue.is_empty();
            if is_alone {
                heard = own.queue.pop_front();
            }
        }
        let now = state.present();
        drop(state);
        if heard.is_none() {
            let time = timeout
                .map(|seconds| micros(seconds.max(0.0), "the time-out"))
                .transpose()?;
            let wait = Wait {
                port: Some(self.id),
                until: time.map(|micros| now.plus_micros(micros)),
                ..Wait::default()
            };
            let mut is_closed = false;
            pass(py, &wire, wait, in_turn, &mut |state| {
                match state.listener(self.id) {
                    Some(own) => heard = own.queue.pop_front(),
                    None => is_closed = true,
                }
                Ok(heard.is_some() || is_closed)
            })?;
            if is_closed {
                return Err(Fault::system("the bus was closed while it received").into());
            }
        }
        heard
            .map(|heard| self.message(py, &wire, heard))
            .transpose()
    }

    /// Lets only frames through that pass one of the filters: CAN-ID, mask, extended.
    fn set_filters(
        &self,
        py: Python<'_>,
        filters: Option<Vec<(u32, u32, Option<bool>)>>,
    ) -> PyResult<()> {
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        let filters = filters.map(|all| {
            let filters = all.into_iter();
            filters
                .map(|(id, mask, extended)| Filter { id, mask, extended })
                .collect()
        });
        if let Some(own) = state.listener(self.id) {
            own.filters = filters;
        }
        Ok(())
    }

    /// Drops received frames that were not read.
    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        if let Some(own) = self.wire()?.enter(py)?.listener(self.id) {
            own.queue.clear();
        }
        Ok(())
    }

    /// Creates a task that sends frames cyclically, and returns its number.
    #[pyo3(signature = (frames, period, duration=None, maker=None))]
    fn task(
        &self,
        py: Python<'_>,
        frames: Vec<Parts>,
        period: f64,
        duration: Option<f64>,
        maker: Option<Py<PyAny>>,
    ) -> PyResult<u32> {
        let frames = frames
            .into_iter()
            .map(Parts::frame)
            .collect::<Result<Vec<Frame>, _>>()?;
        let times = (
            micros(period, "the period")?,
            duration
                .map(|time| micros(time, "the duration"))
                .transpose()?,
        );
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        let id = state.number();
        let calls = maker.is_some();
        state
            .cyclics
            .push(Cyclic::new(id, self.id, frames, times, calls));
        drop(state);
        wire.set_maker(py, id, maker)?;
        Ok(id)
    }

    /// Starts a task with its first frame.
    fn start_task(&self, py: Python<'_>, id: u32) -> PyResult<()> {
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        let now = state.now();
        let own = state.cyclics.iter_mut().find(|one| one.id == id);
        own.ok_or_else(|| Fault::value("the task has ended"))?
            .start(now);
        Ok(())
    }

    /// Replaces the frames of a task.
    fn change_task(&self, py: Python<'_>, id: u32, frames: Vec<Parts>) -> PyResult<()> {
        let frames = frames
            .into_iter()
            .map(Parts::frame)
            .collect::<Result<Vec<Frame>, _>>()?;
        let wire = self.wire()?;
        let mut state = wire.enter(py)?;
        let own = state.cyclics.iter_mut().find(|one| one.id == id);
        own.ok_or_else(|| Fault::value("the task has ended"))?
            .frames = frames;
        Ok(())
    }

    /// Stops a task; it can start again.
    fn stop_task(&self, py: Python<'_>, id: u32) -> PyResult<()> {
        if let Ok(wire) = self.wire() {
            let mut state = wire.enter(py)?;
            state
                .cyclics
                .iter_mut()
                .filter(|one| one.id == id)
                .for_each(Cyclic::stop);
        }
        Ok(())
    }

    /// State of the CAN controller of the programs: 0 error active, 1 error passive, 2 bus-off.
    fn condition(&self) -> PyResult<u8> {
        Ok(
            match self.wire()?.lock().bus.line.controller(0).error_state() {
                ErrorState::BusOff => 2,
                ErrorState::ErrorPassive => 1,
                _ => 0,
            },
        )
    }

    /// The bench of the wire.
    fn bench(&self) -> PyResult<Bench> {
        Ok(Bench { wire: self.wire()? })
    }

    /// Leaves the bus; a second call has no effect.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let wire = self
            .wire
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take();
        let Some(wire) = wire else {
            return Ok(());
        };
        let mut state = wire.lock();
        state.changes += 1;
        state.listeners.retain(|one| one.id != self.id);
        let (own, others): (Vec<_>, _) =
            state.cyclics.drain(..).partition(|one| one.port == self.id);
        state.cyclics = others;
        let is_empty = state.listeners.is_empty();
        state.wake();
        drop(state);
        if is_empty && wire.of_channel {
            wire.release();
        }
        own.iter()
            .try_for_each(|one| wire.set_maker(py, one.id, None))
    }

    fn __repr__(&self) -> String {
        match self.wire() {
            Ok(wire) => format!("<odkit.Port {} of {}>", self.id, wire.name),
            Err(_) => String::from("<odkit.Port closed>"),
        }
    }
}

impl Port {
    fn message<'p>(
        &self,
        py: Python<'p>,
        wire: &Wire,
        heard: Heard,
    ) -> PyResult<Bound<'p, PyTuple>> {
        let at = wire.seconds(heard.at);
        let (id, extended, remote, is_error, dlc, data) = match &heard.what {
            What::Frame(frame) => {
                let id = frame.id();
                let remote = frame.is_remote();
                (
                    id.raw(),
                    id.is_extended(),
                    remote,
                    false,
                    frame.dlc(),
                    frame.data(),
                )
            }
            What::Error(_) => (PROTOCOL_ERROR, false, false, true, 8, &ERROR_DATA[..]),
        };
        let data = if remote {
            PyByteArray::new(py, &[])
        } else {
            PyByteArray::new(py, data)
        };
        let channel = self.channel.bind(py);
        (
            at, id, extended, remote, is_error, channel, dlc, data, false, !heard.own, false, false,
        )
            .into_pyobject(py)
    }
}
