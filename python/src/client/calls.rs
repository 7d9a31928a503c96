//! A CANopen client.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, ThreadId};

use od_client::lss::Identity;
use od_tools::Error;
use od_tools::link::Link;
use od_tools::lss::{Lss, Slaves};
use od_tools::scan::{ScanTimes, scan};
use od_wire::{Frame, NodeId};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyTimeoutError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::client::arguments::{command_of, id_of, seconds_of};
use crate::client::core::Core;
use crate::client::errors::of_transfer;
use crate::client::heard::{Emcy, Found, Pdo};
use crate::client::known::{Known, address};
use crate::client::link::Line;
use crate::client::node::Node;
use crate::files::description::read_of;
use crate::pass::{NAP, sleep};
use crate::value::{from_python, to_python};

/// A CANopen client on a bus: SDO, NMT, LSS, heartbeat, EMCY, PDOs.
///
/// `link` is an `odkit.Bench` or a bus of one (virtual time), a bus of python-can, or a name:
/// `slcan:HOST:PORT`, `slcan:DEVICE[@BAUD]`, `socketcan:INTERFACE`, `socketcand:HOST:PORT[/BUS]`,
/// `bench:DEVICES`. `timeout` is the maximum time to an SDO response in seconds. Values longer than 4 bytes
/// are sent by segmented transfer, from 64 bytes on by block transfer if the node supports it.
///
/// Raises `ValueError` if the name is not that of a link, `OSError` if it cannot be opened.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Client {
    core: Mutex<Option<Core>>,
    /// The thread that uses the client.
    user: Mutex<Option<ThreadId>>,
    /// Whether a call has to end.
    stop: Arc<AtomicBool>,
}

impl Client {
    /// Uses the client, one thread at a time.
    ///
    /// # Errors
    /// The client is closed, or the action fails.
    pub(crate) fn with<T>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Core) -> Result<T, Error>,
    ) -> PyResult<T> {
        let mut guard = self.lock(py)?;
        let core = guard
            .as_mut()
            .ok_or_else(|| PyOSError::new_err("the client is closed"))?;
        self.set_user(Some(thread::current().id()));
        let result = act(core).map_err(|fault| core.line.raised(fault));
        self.set_user(None);
        result
    }

    /// Waits until no other thread uses the client.
    ///
    /// # Errors
    /// `RuntimeError` if this thread does, and an exception such as `KeyboardInterrupt`.
    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Option<Core>>> {
        loop {
            match self.core.try_lock() {
                Ok(guard) => return Ok(guard),
                Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => {}
            }
            let user = *self.user.lock().unwrap_or_else(PoisonError::into_inner);
            if user == Some(thread::current().id()) {
                return Err(PyRuntimeError::new_err(
                    "the client is in a call of this thread; a signal handler or callback inside the call needs a \
                     client of its own",
                ));
            }
            sleep(py, NAP)?;
        }
    }

    fn set_user(&self, user: Option<ThreadId>) {
        *self.user.lock().unwrap_or_else(PoisonError::into_inner) = user;
    }

    fn known(&self, py: Python<'_>, node: u8) -> PyResult<Option<Arc<Known>>> {
        self.with(py, |core| Ok(core.known.get(&node).cloned()))
    }
}

#[pymethods]
impl Client {
    #[new]
    #[pyo3(signature = (link, *, timeout=1.0))]
    fn new(link: &Bound<'_, PyAny>, timeout: f64) -> PyResult<Self> {
        let timeout = seconds_of(timeout, "the time-out")?;
        let stop = Arc::new(AtomicBool::new(false));
        let core = Core::new(Line::open(link, &stop)?, timeout);
        Ok(Self {
            core: Mutex::new(Some(core)),
            user: Mutex::new(None),
            stop,
        })
    }

    fn __enter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    #[pyo3(signature = (*_error))]
    fn __exit__(&self, py: Python<'_>, _error: &Bound<'_, pyo3::types::PyTuple>) -> PyResult<()> {
        self.close(py)
    }

    /// While `on` is `True`, each call that waits ends with `KeyboardInterrupt`. Another thread calls this, such as that of
    /// an `odkit.AsyncClient`.
    #[pyo3(signature = (on=true))]
    fn interrupt(&self, on: bool) {
        self.stop.store(on, Ordering::Relaxed);
    }

    /// Closes the link; a second call has no effect.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let core = self.lock(py)?.take();
        drop(core);
        Ok(())
    }

    /// A node of the bus; with a description (as for `odkit.read`, or its result) its values
    /// have types and names, and its PDOs are decoded.
    ///
    /// Raises `ValueError` if the node ID is not 1 to 127, `OSError` if the description cannot be read.
    #[pyo3(signature = (node_id, eds=None))]
    fn node(slf: Bound<'_, Self>, node_id: u8, eds: Option<&Bound<'_, PyAny>>) -> PyResult<Node> {
        let id = id_of(node_id)?;
        if let Some(eds) = eds {
            let read = read_of(eds)?;
            read.has_objects()?;
            let known = Known::new(&read.description);
            slf.get().with(slf.py(), |core| {
                core.tpdos.retain(|one| one.node != node_id);
                core.tpdos.extend(known.tpdos(node_id));
                core.known.insert(node_id, Arc::new(known));
                Ok(())
            })?;
        }
        Ok(Node {
            client: slf.into_any().unbind(),
            id,
        })
    }

    /// Reads an object by SDO: `client.upload(5, 0x1018, 1)`. With a description of the node it returns a
    /// value, and `object` may be a name; without one it returns `bytes`.
    ///
    /// Raises `odkit.SdoAbort` if the node aborts it, `TimeoutError` if it does not respond, `OSError` if the link is lost,
    /// `ValueError` if the name is not known.
    #[pyo3(signature = (node_id, object, sub=0))]
    fn upload<'p>(
        &self,
        py: Python<'p>,
        node_id: u8,
        object: &Bound<'p, PyAny>,
        sub: u8,
    ) -> PyResult<Bound<'p, PyAny>> {
        let node = id_of(node_id)?;
        let known = self.known(py, node_id)?;
        let address = address(known.as_deref(), object, sub)?;
        let data_type = known.as_ref().and_then(|known| known.type_of(address));
        let (result, timeout) = self.with(py, |core| {
            Ok((core.upload(node, address, data_type)?, core.timeout))
        })?;
        let bytes =
            result.map_err(|error| of_transfer(py, node, address, error, timeout.as_secs_f32()))?;
        match known.and_then(|known| known.type_of(address)) {
            Some(data_type) => to_python(py, data_type, &bytes),
            None => Ok(PyBytes::new(py, &bytes).into_any()),
        }
    }

    /// Writes an object by SDO: `client.download(5, 0x1017, 1000)`. Without a description of the node the
    /// value is `bytes`.
    ///
    /// Raises what `upload` raises; `ValueError` also if the value is not valid for the type.
    #[pyo3(signature = (node_id, object, value, sub=0))]
    fn download(
        &self,
        py: Python<'_>,
        node_id: u8,
        object: &Bound<'_, PyAny>,
        value: &Bound<'_, PyAny>,
        sub: u8,
    ) -> PyResult<()> {
        let node = id_of(node_id)?;
        let known = self.known(py, node_id)?;
        let address = address(known.as_deref(), object, sub)?;
        let bytes = match known.and_then(|known| known.type_of(address)) {
            Some(data_type) => from_python(data_type, value)?,
            None => value.extract::<Vec<u8>>().map_err(|_| {
                PyValueError::new_err(format!(
                    "the type of {address} is not known; give the node its description (`client.node(\
                     {node_id}, \"drive.eds\")`), or write bytes"
                ))
            })?,
        };
        let (result, timeout) = self.with(py, |core| {
            Ok((core.download(node, address, &bytes)?, core.timeout))
        })?;
        result.map_err(|error| of_transfer(py, node, address, error, timeout.as_secs_f32()))
    }

    /// Sends an NMT command to a node, or to all: `start`, `stop`, `pre-operational`, `reset`,
    /// `reset-communication`. Waits at most `timeout` seconds for the resulting state, and returns
    /// it; `None` if it was not received, such as from a node without heartbeat.
    ///
    /// Raises `ValueError` if the command is not known, `OSError` if the link is lost.
    #[pyo3(signature = (command, node_id=None, timeout=0.1))]
    fn nmt(
        &self,
        py: Python<'_>,
        command: &str,
        node_id: Option<u8>,
        timeout: f64,
    ) -> PyResult<Option<&'static str>> {
        let command = command_of(command)?;
        let node = node_id.map(id_of).transpose()?;
        let wait = seconds_of(timeout, "the time-out")?;
        let state = self.with(py, |core| core.nmt(node, command, wait))?;
        Ok(state.map(od_wire::nmt::State::name))
    }

    /// The state in the last received heartbeat of a node; `None` if there was none.
    fn state(&self, py: Python<'_>, node_id: u8) -> PyResult<Option<&'static str>> {
        let node = id_of(node_id)?;
        let state = self.with(py, |core| {
            core.catch_up()?;
            Ok(core.state(node))
        })?;
        Ok(state.map(od_wire::nmt::State::name))
    }

    /// Waits for the next heartbeat or boot-up message of a node, and returns its state.
    ///
    /// Raises `TimeoutError` if none comes within `timeout` seconds.
    #[pyo3(signature = (node_id, timeout=1.0))]
    fn heartbeat(&self, py: Python<'_>, node_id: u8, timeout: f64) -> PyResult<&'static str> {
        let node = id_of(node_id)?;
        let wait = seconds_of(timeout, "the time-out")?;
        let state = self.with(py, |core| {
            let until = core.line.now() + wait;
            core.listen(until, |heard| {
                let (from, state) = od_client::watch::parse(&heard.frame)?;
                (from == node).then_some(state)
            })
        })?;
        let state = state.ok_or_else(|| {
            PyTimeoutError::new_err(format!("node {node}: no heartbeat within {timeout} s"))
        })?;
        Ok(state.name())
    }

    /// Monitors the heartbeat of a node: without one for `seconds` the node is in `lost`. `None` ends that.
    #[pyo3(signature = (node_id, seconds))]
    fn watch(&self, py: Python<'_>, node_id: u8, seconds: Option<f64>) -> PyResult<()> {
        let node = id_of(node_id)?;
        let time = seconds
            .map(|time| seconds_of(time, "the time of a heartbeat"))
            .transpose()?;
        self.with(py, |core| {
            core.watch(node, time);
            Ok(())
        })
    }

    /// Node IDs of the monitored nodes whose heartbeat is missing.
    #[getter]
    fn lost(&self, py: Python<'_>) -> PyResult<Vec<u16>> {
        self.with(py, |core| {
            core.catch_up()?;
            Ok(core.lost.iter().map(|node| node.raw().into()).collect())
        })
    }

    /// The oldest EMCY message that was not returned yet, of any node or of this one.
    ///
    /// Raises `TimeoutError` if none comes within `timeout` seconds.
    #[pyo3(signature = (timeout=1.0, node_id=None))]
    fn emcy(&self, py: Python<'_>, timeout: f64, node_id: Option<u8>) -> PyResult<Emcy> {
        let wait = seconds_of(timeout, "the time-out")?;
        let found = self.with(py, |core| {
            core.catch_up()?;
            let is_its = |node: NodeId| node_id.is_none_or(|id| id == node.raw());
            if !core.emcys.iter().any(|(_, node, _)| is_its(*node)) {
                let until = core.line.now() + wait;
                core.listen(until, |heard| {
                    od_client::emcy::parse(&heard.frame).filter(|(node, _)| is_its(*node))
                })?;
            }
            let at = core.emcys.iter().position(|(_, node, _)| is_its(*node));
            Ok(at.and_then(|at| core.emcys.remove(at)))
        })?;
        let (at, node, emcy) = found.ok_or_else(|| {
            PyTimeoutError::new_err(format!("no EMCY message within {timeout} s"))
        })?;
        let time = at.as_micros() as f64 / 1e6;
        Ok(Emcy::of(py, node.raw(), time, &emcy))
    }

    /// The oldest PDO that was not returned yet, of any node with a description or of this one.
    ///
    /// Raises `TimeoutError` if none comes within `timeout` seconds.
    #[pyo3(signature = (timeout=1.0, node_id=None))]
    fn pdo(&self, py: Python<'_>, timeout: f64, node_id: Option<u8>) -> PyResult<Pdo> {
        let wait = seconds_of(timeout, "the time-out")?;
        let found = self.with(py, |core| {
            core.catch_up()?;
            let is_its = |node: u8| node_id.is_none_or(|id| id == node);
            let until = core.line.now() + wait;
            loop {
                if let Some(at) = core.pdos.iter().position(|one| is_its(one.tpdo.node)) {
                    return Ok(core.pdos.remove(at));
                }
                if core.line.now() >= until || core.listen(until, |_| Some(()))?.is_none() {
                    let at = core.pdos.iter().position(|one| is_its(one.tpdo.node));
                    return Ok(at.and_then(|at| core.pdos.remove(at)));
                }
            }
        })?;
        let came =
            found.ok_or_else(|| PyTimeoutError::new_err(format!("no PDO within {timeout} s")))?;
        let known = self.known(py, came.tpdo.node)?;
        Pdo::of(py, &came, known.as_deref())
    }

    /// Reads from a node which TPDOs are valid and their current mapping, and uses it to decode them from now on.
    /// Returns their numbers, from 1.
    ///
    /// Raises `TimeoutError` if the node does not respond.
    fn read_mapping(&self, py: Python<'_>, node_id: u8) -> PyResult<Vec<u16>> {
        let node = id_of(node_id)?;
        let (found, timeout) = self.with(py, |core| {
            let found = core.read_mapping(node)?;
            Ok((found, core.timeout.as_secs_f32()))
        })?;
        found.map_err(|(address, error)| of_transfer(py, node, address, error, timeout))
    }

    /// Lets `seconds` pass, and receives frames.
    fn run(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        let wait = seconds_of(seconds, "the time to run")?;
        self.with(py, |core| {
            let until = core.line.now() + wait;
            core.listen(until, |_| None::<()>).map(drop)
        })
    }

    /// Sends a data frame of up to 8 bytes. Raises `ValueError` if the CAN-ID or the data is too long.
    #[pyo3(signature = (can_id, data=Vec::new(), *, extended=false))]
    fn send(&self, py: Python<'_>, can_id: u32, data: Vec<u8>, extended: bool) -> PyResult<()> {
        let frame = od_sim::journal::frame(can_id, &data, extended, false);
        let frame = frame.ok_or_else(|| {
            PyValueError::new_err(format!(
                "CAN-ID {can_id:X}h with {} bytes is not a frame",
                data.len()
            ))
        })?;
        self.with(py, |core| core.line.send(&frame))
    }

    /// Sends SYNC (CAN-ID 80h).
    fn sync(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |core| core.line.send(&Frame::standard(0x80, &[])))
    }

    /// The nodes of the bus: listens for `listen` seconds, then reads the identity of each node that
    /// responds within `answer` seconds. It changes nothing on the bus.
    #[pyo3(signature = (listen=0.5, answer=0.2))]
    fn scan(&self, py: Python<'_>, listen: f64, answer: f64) -> PyResult<Vec<Found>> {
        let times = ScanTimes {
            listen: seconds_of(listen, "the time to listen")?,
            answer: seconds_of(answer, "the time for an answer")?,
        };
        let found = self.with(py, |core| scan(&mut core.line, times, |_| ()))?;
        Ok(found.nodes.into_iter().map(Found::from).collect())
    }

    /// The LSS addresses of the slaves without a node ID, by fastscan: vendor-ID, product code, revision
    /// number, serial number of each.
    ///
    /// Raises `odkit.NodeError` if two have the same address.
    fn lss_scan(&self, py: Python<'_>) -> PyResult<Vec<(u32, u32, u32, u32)>> {
        let found = self.with(py, |core| Lss::new(&mut core.line).scan(|_| ()))?;
        Ok(found.into_iter().map(|one| one.parts().into()).collect())
    }

    /// Sets the node ID of the slave with an LSS address (from `lss_scan`), and stores it with
    /// `store=True`. Returns whether the slave has booted with the new node ID; a slave that had a node ID uses the new
    /// one after its next reset. Some devices accept LSS in Stopped only: `client.nmt("stop", 5)`.
    ///
    /// Raises `odkit.NodeError` if no slave has the address, or if it refuses.
    #[pyo3(signature = (address, node_id, store=false))]
    fn lss_set_node_id(
        &self,
        py: Python<'_>,
        address: (u32, u32, u32, u32),
        node_id: u8,
        store: bool,
    ) -> PyResult<bool> {
        let node = id_of(node_id)?;
        self.with(py, |core| {
            Lss::new(&mut core.line).set_node_id(Identity::new(address.into()), node, store)
        })
    }

    /// Configures the bit rate in kbit/s of the slave with an LSS address, or of all without one; `store=True`
    /// stores it. With `activate` all slaves change the bit rate after this number of milliseconds.
    ///
    /// Raises `ValueError` for a bit rate that CiA 301 does not have, `odkit.NodeError` if a slave refuses.
    #[pyo3(signature = (kbit, address=None, store=false, activate=None))]
    fn lss_set_bit_rate(
        &self,
        py: Python<'_>,
        kbit: u16,
        address: Option<(u32, u32, u32, u32)>,
        store: bool,
        activate: Option<u16>,
    ) -> PyResult<()> {
        let slaves = address.map_or(Slaves::All, |one| Slaves::One(Identity::new(one.into())));
        self.with(py, |core| {
            Lss::new(&mut core.line).set_bit_rate(slaves, kbit, store, activate)
        })
    }

    fn __repr__(&self) -> String {
        let text = match self.core.try_lock().as_deref() {
            Ok(Some(core)) => core.line.to_string(),
            Ok(None) => String::from("closed"),
            Err(_) => String::from("in a call"),
        };
        format!("<odkit.Client {text}>")
    }
}
