//! A bench: devices on a bus, and the controls beside it.

use std::path::PathBuf;
use std::sync::Arc;

use od_sim::logs::Format;
use od_wire::Instant;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyString};

use crate::device::Device;
use crate::diagnose::{self, Incident};
use crate::expect::expect;
use crate::faults::{Fault, write};
use crate::party::Wait;
use crate::pass::{End, pass};
use crate::registry;
use crate::snapshot::Snapshot;
use crate::spec;
use crate::state::State;
use crate::time::{self as times, Time};
use crate::wire::{Wire, micros};

/// Devices on a CAN bus in virtual time, with shafts, power supplies and faults.
///
/// `devices` names built-in devices, EDS, DCF or XDD files, and overlays, each with an optional node
/// ID: `"gxmm@1,eam_mt@2"`, or a list such as `["my.eds+coarse.overlay@5"]`. They are switched
/// on at once. A snapshot in their place makes a bench with its state. `can.Bus(interface="odkit", channel=bench.name)` connects to the bench, and
/// `bench.bus()` does so, too.
///
/// Time moves while every thread that takes part waits: in `run`, `until`, `expect`, in `recv` of a bus, or in
/// Python. A wait in Python takes as long on the clock as on the bus, divided by `pace`. With `time="strict"` it is
/// an error if time follows the clock; with `time="real"` it always does.
///
/// Raises `ValueError` if a device cannot be made, `OSError` if a file cannot be read.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Bench {
    pub(crate) wire: Arc<Wire>,
}

impl Bench {
    fn device_at(&self, place: usize) -> Device {
        Device {
            wire: Arc::clone(&self.wire),
            place,
        }
    }

    /// Waits for a moment, or with `or_frame` for the next frame if that is earlier.
    fn wait(&self, py: Python<'_>, until: Instant, or_frame: bool) -> PyResult<End> {
        let before = self.wire.lock().journal.end();
        let wait = Wait {
            until: Some(until),
            seen: or_frame.then_some(before),
            is_last: !or_frame,
            ..Wait::default()
        };
        pass(py, &self.wire, wait, false, &mut |state| {
            Ok(or_frame && state.journal.end() != before)
        })
    }
}

#[pymethods]
impl Bench {
    #[new]
    #[pyo3(signature = (devices=None, *, name=None, time="virtual", pace=1.0))]
    fn new(
        py: Python<'_>,
        devices: Option<&Bound<'_, PyAny>>,
        name: Option<&str>,
        time: &str,
        pace: f64,
    ) -> PyResult<Self> {
        let time = Time::parse(time)?;
        let name = name.map_or_else(registry::free_name, str::to_owned);
        let mut state = State::default();
        state.pace = times::pace(pace)?;
        let snapshot = devices.and_then(|devices| devices.cast::<Snapshot>().ok());
        match snapshot {
            Some(_) if time == Time::Real => {
                return Err(Fault::value("a snapshot continues in virtual time only").into());
            }
            Some(snapshot) => snapshot.get().restore(&mut state),
            None => {
                for list in lists(devices)? {
                    for (place, line) in spec::add(&mut state.bus, &mut state.names, &list)? {
                        state.story.device(line, place);
                    }
                }
                state.start();
            }
        }
        if registry::find(&name).is_some() {
            return Err(Fault::value(format!("a wire named `{name}` is open already")).into());
        }
        state.collect();
        let wire = registry::add(py, name, state, time, false)?;
        Ok(Self { wire })
    }

    fn __enter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    #[pyo3(signature = (*_error))]
    fn __exit__(&self, _error: &Bound<'_, pyo3::types::PyTuple>) {
        self.close();
    }

    /// Frees the name for another bench. Open buses stay open.
    fn close(&self) {
        self.wire.release();
    }

    /// The name of the bus: the `channel` of `can.Bus(interface="odkit", channel=…)`.
    #[getter]
    fn name(&self) -> &str {
        &self.wire.name
    }

    /// The current time in seconds since the start of the bench.
    #[getter]
    fn now(&self) -> f64 {
        self.wire.lock().now().as_micros() as f64 / 1e6
    }

    /// The devices, in the order of their names in `devices`.
    #[getter]
    fn devices(&self) -> Vec<Device> {
        let count = self.wire.lock().bus.devices().len();
        (0..count).map(|place| self.device_at(place)).collect()
    }

    /// The device with a name, or with a node ID: `bench["gxmm"]`, `bench[5]`.
    ///
    /// Raises `KeyError` if no device has it.
    fn __getitem__(&self, device: &Bound<'_, PyAny>) -> PyResult<Device> {
        let (id, name) = match device.extract::<u8>() {
            Ok(id) => (Some(id), None),
            Err(_) => (None, Some(device.extract::<String>()?)),
        };
        let state = self.wire.lock();
        let place = match (id, &name) {
            (Some(id), _) => state
                .bus
                .devices()
                .iter()
                .position(|one| one.is_configured() && one.node_id().raw() == id),
            (None, name) => state.names.iter().position(|own| {
                name.as_ref()
                    .is_some_and(|name| own.eq_ignore_ascii_case(name))
            }),
        };
        let known = state.names.join(", ");
        drop(state);
        let place = place.ok_or_else(|| {
            let text = format!("no device is named {device}; the devices are {known}");
            pyo3::exceptions::PyKeyError::new_err(text)
        })?;
        Ok(self.device_at(place))
    }

    fn __len__(&self) -> usize {
        self.wire.lock().bus.devices().len()
    }

    /// Adds another device to the bus, with power unless `power=False`, and returns it. For an encoder
    /// with two channels it returns the first one.
    ///
    /// Raises `ValueError` or `OSError` like the bench.
    #[pyo3(signature = (device, *, power=true))]
    fn add(&self, py: Python<'_>, device: &str, power: bool) -> PyResult<Device> {
        let mut state = self.wire.enter(py)?;
        let state = &mut *state;
        let now = state.now();
        state.story.reach(now, &state.due());
        let first_new = state.bus.devices().len();
        let added = spec::add(&mut state.bus, &mut state.names, device)?;
        for (place, line) in &added {
            let off = if power { "" } else { " off" };
            state.story.device(format!("{line}{off}"), *place);
        }
        state.story.acted = true;
        for place in first_new..state.bus.devices().len() {
            if power {
                state.bus.start(place);
            }
        }
        state.collect();
        state.wake();
        let first = added.first().map(|(place, _)| *place);
        Ok(self.device_at(first.ok_or_else(|| Fault::value("no device is named"))?))
    }

    /// Lets `seconds` pass. Programs that listen to the bus run during this time.
    ///
    /// Raises `ValueError` if `seconds` is negative.
    fn run(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        let time = micros(seconds, "the time to run")?;
        let until = {
            let state = self.wire.enter(py)?;
            state.present().plus_micros(time)
        };
        self.wait(py, until, false)?;
        Ok(())
    }

    /// Lets time pass until `condition()` is true, and returns the seconds that passed. It is called
    /// after every frame, and every millisecond. A text is a frame, as in `expect`.
    ///
    /// Raises `TimeoutError` if it is not true within `timeout` seconds.
    #[pyo3(signature = (condition, timeout=10.0))]
    fn until(&self, py: Python<'_>, condition: &Bound<'_, PyAny>, timeout: f64) -> PyResult<f64> {
        if let Ok(frame) = condition.cast::<PyString>() {
            let began = self.now();
            expect(py, &self.wire, &frame.extract::<String>()?, timeout)?;
            return Ok(self.now() - began);
        }
        let time = micros(timeout, "the time-out")?;
        let began = self.wire.enter(py)?.now();
        let end = began.plus_micros(time);
        loop {
            let now = self.wire.lock().now();
            if condition.call0()?.is_truthy()? {
                return Ok(now.micros_since(began) as f64 / 1e6);
            }
            if now >= end {
                let text = format!("the condition is not true after {timeout} s");
                return Err(Fault::Late(text).into());
            }
            self.wait(py, now.plus_micros(1000).min(end), true)?;
        }
    }

    /// Lets time pass until a frame is sent, at most `within` seconds, and returns its line of the log.
    /// `..` is any byte, `*` any rest: `bench.expect("581#43 04 60 00 *", within=0.1)`. A frame that was
    /// sent after the last frame of a program counts, too, if that is not longer ago than `within` and no
    /// `expect` has found it before.
    ///
    /// Raises `AssertionError` with the frames that were sent instead.
    #[pyo3(signature = (frame, within=1.0))]
    fn expect(&self, py: Python<'_>, frame: &str, within: f64) -> PyResult<String> {
        expect(py, &self.wire, frame, within)
    }

    /// A bus of python-can on this bench; keywords are those of `can.Bus`.
    #[pyo3(signature = (**keywords))]
    fn bus<'p>(
        slf: Bound<'p, Self>,
        keywords: Option<Bound<'p, pyo3::types::PyDict>>,
    ) -> PyResult<Bound<'p, PyAny>> {
        let py = slf.py();
        let keywords = keywords.unwrap_or_else(|| pyo3::types::PyDict::new(py));
        keywords.set_item("channel", slf.get().name())?;
        keywords.set_item("bench", &slf)?;
        py.import("odkit.bus")?
            .getattr("OdkitBus")?
            .call((), Some(&keywords))
    }

    /// The bit rate of the programs in kbit/s. A device with another bit rate neither sends to them nor
    /// receives from them; `None`, the default: all bit rates match.
    #[getter]
    fn get_bit_rate(&self) -> Option<u16> {
        self.wire.lock().bus.bit_rate()
    }

    #[setter]
    fn set_bit_rate(&self, py: Python<'_>, kbit: Option<u16>) -> PyResult<()> {
        let mut state = self.wire.enter(py)?;
        let rate = kbit.map_or(String::from("any"), |kbit| kbit.to_string());
        state.tell(None, &format!("bus bitrate {rate}"));
        state.bus.set_bit_rate(kbit);
        state.bus.line.bit_rate = kbit;
        Ok(())
    }

    /// Whether frames take time and can fail, as on a CAN bus: they need terminators, another
    /// node that acknowledges them, and one bit rate. `False`, the default: each frame is received
    /// at once. A change drops the waiting frames.
    #[getter]
    fn get_real_line(&self) -> bool {
        self.wire.lock().bus.line.is_real()
    }

    #[setter]
    fn set_real_line(&self, py: Python<'_>, real: bool) -> PyResult<()> {
        let mut state = self.wire.enter(py)?;
        if real {
            state.story.cannot("`real_line`");
        }
        state.bus.line.set_real(real);
        Ok(())
    }

    /// The number of terminators (120 Ω), 2 by default. With another number frames fail
    /// on a real line.
    #[getter]
    fn get_terminators(&self) -> u8 {
        self.wire.lock().bus.line.terminators
    }

    #[setter]
    fn set_terminators(&self, py: Python<'_>, count: u8) -> PyResult<()> {
        self.wire.enter(py)?.bus.line.terminators = count;
        Ok(())
    }

    /// Seeds the random disturbances of a real line. The same seed gives the same sequence.
    ///
    /// Raises `ValueError` if it is negative or has more than 64 bits.
    fn seed(&self, py: Python<'_>, seed: &Bound<'_, PyAny>) -> PyResult<()> {
        let number: u64 = match seed.extract() {
            Ok(number) => number,
            Err(error) if error.is_instance_of::<PyTypeError>(py) => return Err(error),
            Err(_) => {
                let why = format!("seed is {seed}; it must be 0 to {}", u64::MAX);
                return Err(Fault::value(why).into());
            }
        };
        self.wire.enter(py)?.bus.line.set_seed(number);
        Ok(())
    }

    /// Restarts the CAN controller of a device after bus-off, or that of the programs if no device is
    /// given.
    #[pyo3(signature = (device=None))]
    fn restart(&self, py: Python<'_>, device: Option<&Device>) -> PyResult<()> {
        let station = device.map_or(0, |device| device.place + 1);
        let mut state = self.wire.enter(py)?;
        state.story.cannot("`restart`");
        state.bus.restart_controller(station);
        state.collect();
        state.wake();
        Ok(())
    }

    /// The inputs so far as a script: `odkit run` plays it with the same frames. The script contains the frames of
    /// programs and their times, so it needs none of these programs.
    ///
    /// Raises `ValueError` if a script has no line for something, such as a real line or a new EEPROM.
    fn script(&self) -> PyResult<String> {
        let state = self.wire.lock();
        let script = state.story.script(state.now(), &state.due());
        Ok(script.map_err(Fault::Value)?)
    }

    /// The script as the end of an address of the playground, `#bench=…`: the page repeats it. The page has built-in
    /// devices only.
    ///
    /// Raises what `script` raises.
    fn link<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyAny>> {
        let (script, now) = (self.script()?, self.now());
        py.import("odkit._campaign")?
            .getattr("link_of")?
            .call1((script, now))
    }

    /// The state of the bench, for `restore`.
    fn snapshot(&self) -> Snapshot {
        Snapshot::of(&self.wire.lock())
    }

    /// Refuses to be pickled, since other threads and buses may use the bench: its snapshot can be.
    fn __reduce__(&self) -> PyResult<()> {
        Err(PyTypeError::new_err(
            "a Bench cannot be pickled or copied; use `bench.snapshot()`, and make a bench of it with `odkit.Bench(snapshot)`",
        ))
    }

    /// Restores a state, including its time. The journal starts again, and received frames that were
    /// not read are dropped.
    fn restore(&self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        snapshot.restore(&mut *self.wire.enter(py)?);
        Ok(())
    }

    /// The frames so far, one text per line: time, frame, and its meaning in words. The last 2,000,000
    /// are kept.
    #[getter]
    fn log(&self) -> Vec<String> {
        let state = self.wire.lock();
        state.journal.lines(state.bus.devices(), 0)
    }

    /// The faults in the frames so far, in the order of their beginning, as `odkit diagnose` finds them in a log. It knows
    /// the dictionaries of the devices. A healthy bus has none.
    fn diagnose(&self) -> Vec<Incident> {
        diagnose::of(&mut self.wire.lock())
    }

    /// The frames so far in the format of candump (`candump -L`), or in one of the formats
    /// `asc`, `trc` and `pcapng`.
    ///
    /// Raises `ValueError` if the format is not one of them.
    #[pyo3(signature = (format="log"))]
    fn journal<'p>(&self, py: Python<'p>, format: &str) -> PyResult<Bound<'p, PyBytes>> {
        let known = Format::of_ending(if format == "candump" { "log" } else { format });
        let known = known.ok_or_else(|| {
            Fault::value(format!(
                "format `{format}` is not known; write `log`, `asc`, `trc` or `pcapng`"
            ))
        })?;
        Ok(PyBytes::new(
            py,
            &known.write(self.wire.lock().journal.records()),
        ))
    }

    /// Saves the frames so far; the extension of the file selects the format: `.log`, `.asc`, `.trc`,
    /// `.pcapng`.
    ///
    /// Raises `ValueError` if the extension is not one of them, `OSError` if the file cannot be written.
    fn save_log(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let ending = path
            .extension()
            .map_or_else(String::new, |it| it.to_string_lossy().into_owned());
        let bytes = self.journal(py, &ending)?;
        write(&path, bytes.as_bytes())
    }

    fn __repr__(&self) -> String {
        let state = self.wire.lock();
        format!(
            "<odkit.Bench {}: {} at {:?} s>",
            self.wire.name,
            state.names.join(", "),
            state.now()
        )
    }
}

/// The lists of devices in a text, a path, or a list of them.
fn lists(devices: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<String>> {
    let Some(devices) = devices else {
        return Ok(Vec::new());
    };
    let text = |one: &Bound<'_, PyAny>| one.str()?.extract::<String>();
    let is_list =
        devices.is_instance_of::<PyList>() || devices.is_instance_of::<pyo3::types::PyTuple>();
    if !is_list {
        return Ok(vec![text(devices)?]);
    }
    devices.try_iter()?.map(|one| text(&one?)).collect()
}
