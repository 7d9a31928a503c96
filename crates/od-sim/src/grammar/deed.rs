//! Actions on the bus and its surroundings that any bench can carry out.

use std::format;
use std::prelude::v1::*;

use od_runtime::{BusEvent, Frame, PinKind};

use super::master::MasterLine;
use super::named_frame::{NamedFrame, Write};
use crate::bench::Bench;
use crate::line::cable::Property;

/// A change of a shaft.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ShaftChange {
    /// To a raw position.
    At(u64),
    /// By revolutions, backwards if negative.
    Turn(f64),
    /// At this speed from now on, in revolutions per minute.
    Rpm(f64),
    /// With constant acceleration to a speed in revolutions per minute, in a time in microseconds.
    Ramp(f64, u64),
}

/// A change of the bus line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LineChange {
    /// Frames may fail.
    Real(bool),
    /// Number of terminating resistors.
    Terminators(u8),
    /// Bit rate of the outside in kbit/s; `None`: that of the first device.
    BitRate(Option<u16>),
    /// Whether the current device is connected.
    Plugged(bool),
    /// A property of the cable, or of the current device on it.
    Cable(Property),
    /// The CAN controller of the outside starts again, as after bus-off.
    Restarted,
}

/// An action that does not wait for a result.
#[derive(Clone, PartialEq, Debug)]
pub enum Deed {
    /// Nothing: only time passes.
    Wait,
    /// The following lines are about this device.
    Use(String),
    /// Sends a frame.
    Send {
        /// The frame.
        frame: NamedFrame,
        /// Number of frames.
        times: u32,
        /// Period in microseconds.
        every: u64,
    },
    /// Power on (`true`) or off.
    Power(bool),
    /// Power off for this time in microseconds, then on.
    Cycle(u64),
    /// A movement of the shaft.
    Shaft(ShaftChange),
    /// The rotary switches of the node ID.
    NodeSwitch(u8),
    /// The DIP switches of the bit rate.
    RateSwitch(u8),
    /// A fault of the device begins or ends.
    Fault(&'static str, bool),
    /// The device reports an error.
    RaiseError {
        /// EMCY code.
        code: u16,
        /// Bits of the error register.
        register: u8,
        /// `None`: the default bytes of its family.
        info: Option<[u8; 5]>,
    },
    /// Ends the errors with this code, or with 0 all errors.
    ClearError(u16),
    /// Sets a value of the device.
    Set(Write),
    /// Sets an input of the device.
    Pin(String, i64),
    /// Wires a connection to an input, both as `device.pin` or of the current device.
    Connect(String, String),
    /// An event of the CAN controller.
    Controller(BusEvent),
    /// Bit rate of the outside in kbit/s; `None`: any.
    BusRate(Option<u16>),
    /// A change of the bus line.
    Line(LineChange),
    /// A line of the master's list, or a command to the master.
    Master(MasterLine),
}

impl Deed {
    /// The rest of the action after [`act`](Self::act), and its delay in microseconds.
    pub(crate) fn rest(&self) -> Option<(u64, Self)> {
        match self {
            Self::Send {
                frame,
                times,
                every,
            } if *times > 1 => {
                let (frame, every) = (frame.clone(), *every);
                let times = times - 1;
                Some((
                    every,
                    Self::Send {
                        frame,
                        times,
                        every,
                    },
                ))
            }
            Self::Cycle(micros) => Some((*micros, Self::Power(true))),
            _ => None,
        }
    }

    /// Carries out the first part. It returns a frame instead of sending it: the caller puts it on the bus.
    ///
    /// # Errors
    /// Reason why the current device cannot do it.
    pub(crate) fn act(&self, bench: &mut Bench) -> Result<Option<Frame>, String> {
        match self {
            Self::Wait => {}
            Self::Use(name) => bench.current = bench.named(name)?,
            Self::Send { frame, .. } => return Ok(Some(frame.of(bench.present()?)?)),
            Self::Power(on) => bench.bus.set_power(bench.current, *on),
            Self::Cycle(_) => bench.bus.set_power(bench.current, false),
            Self::Shaft(shaft) => {
                let turned = bench.with(|device, now| match *shaft {
                    ShaftChange::At(raw) => device.set_position(raw, now),
                    ShaftChange::Turn(turns) => device.turn(turns, now),
                    ShaftChange::Rpm(rpm) => device.set_rpm(rpm, now),
                    ShaftChange::Ramp(rpm, micros) => device.ramp_to_rpm(rpm, micros, now),
                })?;
                if !turned {
                    return Err("this device has no shaft".into());
                }
            }
            Self::NodeSwitch(number) => {
                bench.with(|device, now| device.set_node_switch(*number, now))?;
            }
            Self::RateSwitch(number) => {
                bench.with(|device, now| device.set_bitrate_switch(*number, now))?;
            }
            Self::Fault(name, on) => {
                if !bench.with(|device, now| device.set_fault(name, *on, now))? {
                    let known = bench.present()?.faults().join(", ");
                    return Err(format!(
                        "this device does not support the fault `{name}`; it supports {known}"
                    ));
                }
            }
            Self::RaiseError {
                code,
                register,
                info,
            } => {
                bench.with(|device, now| device.raise_error(*code, *register, *info, now))??;
            }
            Self::ClearError(code) => {
                bench.with(|device, now| device.clear_error(*code, now))??
            }
            Self::Set(write) => {
                let (address, bytes) = write.own(bench.present()?.dictionary())?;
                bench.with(|device, now| device.set_value(address, &bytes, now))??;
            }
            Self::Pin(name, value) => {
                let number = bench.present()?.pin_named(name)?;
                if bench.present()?.pins()[number].kind != PinKind::Input {
                    return Err(format!("`{name}` is not an input"));
                }
                bench.with(|device, now| device.set_pin(number, *value, now))?;
            }
            Self::Connect(from, to) => {
                let end = |name: &'_ str| match name.rsplit_once('.') {
                    Some((device, _)) => bench.named(device),
                    None => Ok(bench.current),
                };
                let ends = (end(from)?, end(to)?);
                let pin = |name: &'_ str| match name.rsplit_once('.') {
                    Some((_, pin)) => pin.to_owned(),
                    None => name.to_owned(),
                };
                bench
                    .bus
                    .connect((ends.0, &pin(from)), (ends.1, &pin(to)))?;
            }
            Self::Controller(event) => bench.with(|device, now| device.handle_bus(*event, now))?,
            Self::BusRate(kbit) => bench.bus.set_bit_rate(*kbit),
            Self::Master(line) => {
                let order = line.order(&bench.bus)?;
                bench.bus.order_master(&order)?;
            }
            Self::Line(change) => {
                let (line, station) = (&mut bench.bus.line, bench.current + 1);
                match *change {
                    LineChange::Real(real) => line.set_real(real),
                    LineChange::Terminators(count) => line.terminators = count,
                    LineChange::BitRate(kbit) => line.bit_rate = kbit,
                    LineChange::Plugged(plugged) => line.set_plugged(station, plugged),
                    LineChange::Cable(property) => line.set_property(station, property)?,
                    LineChange::Restarted => line.restart(0),
                }
            }
        }
        Ok(None)
    }
}
