//! One device of a bench, with its shaft, power supply and switches.

use std::path::PathBuf;
use std::sync::Arc;

use od_model::{Address, DataType, values};
use od_runtime::Instant;
use od_sim::VirtualDevice;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::faults::{Fault, of_file, write};
use crate::story;
use crate::value::{from_python, to_python};
use crate::wire::{Wire, finite, micros};

/// A device of a bench, from `bench["gxmm"]` or `bench.devices`.
///
/// Attributes are read at the current time of the bench and send nothing on the bus. A method for
/// a feature that the device does not have raises `ValueError`.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Device {
    pub(crate) wire: Arc<Wire>,
    pub(crate) place: usize,
}

impl Device {
    /// Changes something beside the bus, and wakes the waiting threads. `line` is the change as a line of a script, or the
    /// name of a change that scripts do not have; the bench records it if the change `is_done`.
    fn act<R>(
        &self,
        py: Python<'_>,
        line: Result<&str, &str>,
        is_done: impl FnOnce(&R) -> bool,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> R,
    ) -> PyResult<R> {
        let mut state = self.wire.enter(py)?;
        state.acted = state.now();
        let due = state.due();
        let result = state.bus.with(self.place, act);
        let now = state.now();
        match (result.as_ref().is_some_and(is_done), line) {
            (true, Ok(line)) => state.story.add(now, &due, Some(self.place), line),
            (true, Err(what)) => state.story.cannot(what),
            (false, _) => {}
        }
        state.collect();
        state.wake();
        Ok(result.ok_or_else(gone)?)
    }

    /// Like `act`, if the device may not have the feature.
    fn turn_something(
        &self,
        py: Python<'_>,
        line: &str,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> bool,
    ) -> PyResult<()> {
        if self.act(py, Ok(line), |turned| *turned, act)? {
            Ok(())
        } else {
            Err(Fault::value("this device has no shaft").into())
        }
    }

    /// Reads the state of the device.
    fn look<R>(&self, look: impl FnOnce(&VirtualDevice, Instant) -> R) -> PyResult<R> {
        let state = self.wire.lock();
        let device = state.bus.devices().get(self.place);
        Ok(look(device.ok_or_else(gone)?, state.now()))
    }

    fn shaft(&self) -> PyResult<od_sim::ShaftView> {
        let shaft = self.look(|device, now| device.shaft(now))?;
        Ok(shaft.ok_or_else(|| Fault::value("this device has no shaft"))?)
    }
}

fn gone() -> Fault {
    Fault::value("the device is not on the bench any more")
}

/// An object as a caller names it. It is read before the lock of a bus is taken: reading it may run Python.
enum Key {
    Address(Address),
    Name(String),
}

impl Key {
    /// `0x6004`, `(0x1018, 2)`, `"1018h:02"` or the name of an object.
    fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok((index, sub)) = object.extract::<(u16, u8)>() {
            return Ok(Self::Address(Address::new(index, sub)));
        }
        if let Ok(index) = object.extract::<u16>() {
            return Ok(Self::Address(Address::new(index, 0)));
        }
        Ok(Self::Name(object.str()?.extract()?))
    }

    fn find(&self, device: &VirtualDevice) -> Result<(Address, DataType), Fault> {
        let text = match self {
            Self::Address(address) => address.to_string(),
            Self::Name(name) => name.clone(),
        };
        let entry = values::find(device.dictionary(), &text).map_err(Fault::from)?;
        Ok((entry.address, entry.data_type))
    }
}

#[pymethods]
impl Device {
    /// The name on the bench: that of the built-in device or of the file, with a number if it is
    /// not the first one.
    #[getter]
    fn name(&self) -> PyResult<String> {
        let state = self.wire.lock();
        Ok(state.names.get(self.place).cloned().ok_or_else(gone)?)
    }

    /// The title of the family, or `ProductName` of the file.
    #[getter]
    fn title(&self) -> PyResult<String> {
        self.look(|device, _| device.title().to_owned())
    }

    /// The active node ID, 1 to 127; `None` for a device without one (LSS).
    #[getter]
    fn node_id(&self) -> PyResult<Option<u8>> {
        self.look(|device, _| device.is_configured().then(|| device.node_id().raw()))
    }

    /// The NMT state: `Initialising`, `Pre-operational`, `Operational`, `Stopped`, or `off`.
    #[getter]
    fn state(&self) -> PyResult<&'static str> {
        self.look(|device, _| {
            if device.is_powered() {
                device.state().name()
            } else {
                "off"
            }
        })
    }

    /// The bit rate of the device in kbit/s; `None` for one that adapts itself.
    #[getter]
    fn bit_rate(&self) -> PyResult<Option<u16>> {
        self.look(|device, _| device.bit_rate())
    }

    /// The LEDs, green and red: each `off`, `flashing` or `on`.
    #[getter]
    fn leds(&self) -> PyResult<(&'static str, &'static str)> {
        self.look(|device, _| {
            let (green, red) = device.leds();
            (green.name(), red.name())
        })
    }

    /// Vendor-ID, product code, revision number and serial number at the first start.
    #[getter]
    fn lss_address(&self) -> PyResult<(u32, u32, u32, u32)> {
        self.look(|device, _| device.lss_address().into())
    }

    /// Power: `True` or `False`. Setting it takes effect at once.
    #[getter]
    fn get_power(&self) -> PyResult<bool> {
        self.look(|device, _| device.is_powered())
    }

    #[setter]
    fn set_power(&self, py: Python<'_>, on: bool) -> PyResult<()> {
        let mut state = self.wire.enter(py)?;
        state.acted = state.now();
        if self.place >= state.bus.devices().len() {
            return Err(gone().into());
        }
        state.tell(Some(self.place), if on { "power on" } else { "power off" });
        state.bus.set_power(self.place, on);
        state.collect();
        state.wake();
        Ok(())
    }

    /// Revolutions of the shaft from the zero point of the sensor. Setting it moves the shaft;
    /// the speed stays.
    #[getter]
    fn get_turns(&self) -> PyResult<f64> {
        Ok(self.shaft()?.turns)
    }

    #[setter]
    fn set_turns(&self, py: Python<'_>, turns: f64) -> PyResult<()> {
        let turns = finite(turns, "a position in revolutions")?;
        let way = turns - self.shaft()?.turns;
        let line = format!("shaft turn {way}");
        self.turn_something(py, &line, |device, now| device.turn(way, now))
    }

    /// The position of the sensor in steps, before scaling and preset. Setting it moves the shaft;
    /// the speed stays.
    #[getter]
    fn get_position(&self) -> PyResult<u64> {
        Ok(self.shaft()?.raw)
    }

    #[setter]
    fn set_position(&self, py: Python<'_>, raw: u64) -> PyResult<()> {
        let line = format!("shaft at {raw}");
        self.turn_something(py, &line, |device, now| device.set_position(raw, now))
    }

    /// The speed of the shaft in revolutions per minute, positive clockwise. Setting it takes effect
    /// at once.
    #[getter]
    fn get_rpm(&self) -> PyResult<f64> {
        Ok(self.shaft()?.rpm)
    }

    #[setter]
    fn set_rpm(&self, py: Python<'_>, rpm: f64) -> PyResult<()> {
        let rpm = finite(rpm, "a speed")?;
        let line = format!("shaft rpm {rpm}");
        self.turn_something(py, &line, |device, now| device.set_rpm(rpm, now))
    }

    /// Turns the shaft by a number of revolutions at once; the speed stays.
    fn turn(&self, py: Python<'_>, turns: f64) -> PyResult<()> {
        let turns = finite(turns, "a number of revolutions")?;
        let line = format!("shaft turn {turns}");
        self.turn_something(py, &line, |device, now| device.turn(turns, now))
    }

    /// Changes the speed evenly to `rpm` revolutions per minute within `seconds`, at most 4295 s.
    fn ramp(&self, py: Python<'_>, rpm: f64, seconds: f64) -> PyResult<()> {
        let (rpm, seconds) = (
            finite(rpm, "a speed")?,
            finite(seconds, "the time of a ramp")?,
        );
        let time = micros(seconds, "the time of a ramp")?;
        let line = format!("shaft ramp {rpm} over {time}us");
        self.turn_something(py, &line, |device, now| device.ramp_to_rpm(rpm, time, now))
    }

    /// The faults that this device supports.
    #[getter]
    fn faults(&self) -> PyResult<Vec<&'static str>> {
        self.look(|device, _| device.faults())
    }

    /// Causes a fault of `faults`, or ends it with `on=False`.
    ///
    /// Raises `ValueError` if the device does not support it.
    #[pyo3(signature = (name, on=true))]
    fn fault(&self, py: Python<'_>, name: &str, on: bool) -> PyResult<()> {
        let line = format!("fault {name} {}", if on { "on" } else { "off" });
        if self.act(
            py,
            Ok(&line),
            |known| *known,
            |device, now| device.set_fault(name, on, now),
        )? {
            return Ok(());
        }
        let known = self.faults()?.join(", ");
        Err(Fault::value(format!(
            "this device does not support the fault `{name}`; it supports {known}"
        ))
        .into())
    }

    /// Whether a fault is active.
    fn is_faulty(&self, name: &str) -> PyResult<bool> {
        self.look(|device, _| device.is_broken(name))
    }

    /// Reports an error: an EMCY message with this code, 1001h and 1003h. `register` has the bits of
    /// 1001h, `info` the five manufacturer-specific bytes.
    ///
    /// Raises `ValueError` if the device has no power or no EMCY messages, or if the error is active.
    #[pyo3(signature = (code, register=1, info=None))]
    fn emcy(&self, py: Python<'_>, code: u16, register: u8, info: Option<[u8; 5]>) -> PyResult<()> {
        let mut line = format!("emcy {code}h register {register}");
        line = line.replace(&format!("{code}h"), &format!("{code:04X}h"));
        if let Some(info) = info {
            line += " info";
            info.iter().for_each(|byte| line += &format!(" {byte:02X}"));
        }
        let result = self.act(py, Ok(&line), Result::is_ok, |device, now| {
            device.raise_error(code, register, info, now)
        })?;
        Ok(result.map_err(Fault::from)?)
    }

    /// Ends an error of `emcy`, or all of them.
    ///
    /// Raises `ValueError` if it is not active.
    #[pyo3(signature = (code=0))]
    fn clear_emcy(&self, py: Python<'_>, code: u16) -> PyResult<()> {
        let line = format!("emcy {code:04X}h off");
        let line = if code == 0 { "emcy 0000h" } else { &line };
        let result = self.act(py, Ok(line), Result::is_ok, |device, now| {
            device.clear_error(code, now)
        })?;
        Ok(result.map_err(Fault::from)?)
    }

    /// The rotary switches of the node ID, 0 to 99; at 0 the device uses the saved node ID. The device reads
    /// them when it starts.
    #[getter]
    fn get_node_switch(&self) -> PyResult<u8> {
        self.look(|device, _| device.switches().0)
    }

    #[setter]
    fn set_node_switch(&self, py: Python<'_>, number: u8) -> PyResult<()> {
        if number > 99 {
            return Err(
                Fault::value(format!("the rotary switches have 0 to 99, not {number}")).into(),
            );
        }
        let line = format!("switch node {number}");
        self.act(
            py,
            Ok(&line),
            |_| true,
            |device, now| device.set_node_switch(number, now),
        )
    }

    /// The DIP switches of the bit rate, 0 to 7. The device reads them when it starts, if the rotary
    /// switches are not 0.
    #[getter]
    fn get_rate_switch(&self) -> PyResult<u8> {
        self.look(|device, _| device.switches().1)
    }

    #[setter]
    fn set_rate_switch(&self, py: Python<'_>, number: u8) -> PyResult<()> {
        if number > 7 {
            return Err(Fault::value(format!("the DIP switches have 0 to 7, not {number}")).into());
        }
        let line = format!("switch bitrate {number}");
        self.act(
            py,
            Ok(&line),
            |_| true,
            |device, now| device.set_bitrate_switch(number, now),
        )
    }

    /// The value of an object: `device[0x6004]`, `device[0x1018, 2]`, `device["Position value"]`.
    /// It is what an SDO upload would return now: `bool`, `int`, `float`, `str` or `bytes`.
    ///
    /// Raises `ValueError` if the object does not exist.
    fn __getitem__<'p>(
        &self,
        py: Python<'p>,
        object: &Bound<'p, PyAny>,
    ) -> PyResult<Bound<'p, PyAny>> {
        let key = Key::of(object)?;
        let mut state = self.wire.lock();
        let found = state.bus.with(self.place, |device, now| {
            let (address, data_type) = key.find(device)?;
            Ok::<_, Fault>((data_type, device.read(address, now)))
        });
        drop(state);
        let (data_type, bytes) = found.ok_or_else(gone)??;
        to_python(py, data_type, &bytes)
    }

    /// Sets the value of an object as the device itself does, also of a read-only object.
    /// Event-driven TPDOs with it are sent. Types and limits are those of the object.
    ///
    /// Raises `ValueError` if the object does not exist, the device computes it, or the value is not
    /// valid for it.
    fn __setitem__<'p>(
        &self,
        py: Python<'p>,
        object: &Bound<'p, PyAny>,
        value: &Bound<'p, PyAny>,
    ) -> PyResult<()> {
        let key = Key::of(object)?;
        let (address, data_type) = self.look(|device, _| key.find(device))??;
        let bytes = from_python(data_type, value)?;
        let line = story::value(data_type, &bytes).map(|value| format!("set {address} = {value}"));
        let line = line
            .as_deref()
            .ok_or("a text with quotes or control characters");
        let result = self.act(py, line, Result::is_ok, |device, now| {
            device.set_value(address, &bytes, now)
        })?;
        Ok(result.map_err(Fault::from)?)
    }

    /// The bytes of the EEPROM. Written bytes take effect at the next start.
    #[getter]
    fn get_eeprom<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyBytes>> {
        let mut state = self.wire.lock();
        let bytes = state.bus.with(self.place, |device, _| device.eeprom());
        Ok(PyBytes::new(py, &bytes.ok_or_else(gone)?))
    }

    #[setter]
    fn set_eeprom(&self, py: Python<'_>, bytes: Vec<u8>) -> PyResult<()> {
        let room = self.look(|device, _| device.storage_needed())?;
        if bytes.len() > room {
            let len = bytes.len();
            return Err(Fault::value(format!("the EEPROM has {room} bytes, not {len}")).into());
        }
        self.act(
            py,
            Err("bytes of an EEPROM"),
            |_| true,
            |device, _| device.set_eeprom(&bytes),
        )
    }

    /// Saves the bytes of the EEPROM to a file. Raises `OSError` if it cannot be written.
    fn save_eeprom(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let bytes = self.get_eeprom(py)?;
        write(&path, bytes.as_bytes())
    }

    /// Loads the EEPROM from a file of `save_eeprom`; it takes effect at the next start. Raises
    /// `OSError` if the file cannot be read, `ValueError` if it is too long.
    fn load_eeprom(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let bytes = std::fs::read(&path).map_err(|error| of_file(&error, &path))?;
        self.set_eeprom(py, bytes)
    }

    /// Cuts the power during the next save, when `after` more bytes have been written.
    fn cut_power(&self, py: Python<'_>, after: usize) -> PyResult<()> {
        self.act(
            py,
            Err("`cut_power`"),
            |_| true,
            |device, _| device.cut_power_after(after),
        )?;
        Ok(())
    }

    /// Whether the device is connected to the bus line. Setting it takes effect at once.
    #[getter]
    fn get_plugged(&self) -> bool {
        self.wire.lock().bus.line.is_plugged(self.place + 1)
    }

    #[setter]
    fn set_plugged(&self, py: Python<'_>, plugged: bool) -> PyResult<()> {
        let mut state = self.wire.enter(py)?;
        state.tell(
            Some(self.place),
            if plugged { "line plug" } else { "line unplug" },
        );
        state.bus.line.set_plugged(self.place + 1, plugged);
        Ok(())
    }

    fn __repr__(&self) -> PyResult<String> {
        let (name, state) = (self.name()?, self.state()?);
        let node = self
            .node_id()?
            .map_or(String::from("without node ID"), |id| format!("node {id}"));
        Ok(format!("<odkit.Device {name}, {node}, {state}>"))
    }
}
