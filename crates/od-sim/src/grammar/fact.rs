//! Conditions about the present moment: reads, evaluates and describes them.

use std::format;
use std::prelude::v1::*;

use od_model::values;
use od_wire::NodeId;
use od_wire::nmt::State;

use super::comparison::{Comparison, SIGNS};
use super::master::{Wanted, node};
use super::problem::Problem;
use super::tokens::{Tokens, fault_name};
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::device::leds::Led;
use crate::device::world::ShaftView;
use crate::line::ErrorState;
use crate::line::cable::Measure;

/// A condition about a device or the bus line.
#[derive(Clone, PartialEq, Debug)]
pub enum Fact {
    /// The current value of an object, by address or name.
    Value(String, Comparison),
    /// The value after the next start; `None`: the current value.
    Saved(String, Option<Comparison>),
    /// `None`: the device has no power.
    State(Option<State>),
    /// The green or the red LED shows this pattern.
    Led {
        /// The green LED, otherwise the red one.
        green: bool,
        /// Pattern of the LED.
        led: Led,
    },
    /// The node ID of the device.
    NodeId(Comparison),
    /// The bit rate in kbit/s.
    BitRate(Comparison),
    /// Revolutions since the step began, as an absolute value.
    Turned(Comparison),
    /// Revolutions per minute.
    Rpm(Comparison),
    /// This fault is active.
    Broken(&'static str),
    /// The value at a connection of the device.
    Pin(String, Comparison),
    /// Resistors at the ends of the bus line.
    Terminators(Comparison),
    /// Error counter of the CAN controller on a real line: of transmit errors, otherwise of receive errors.
    ErrorCounter {
        /// The transmit error counter.
        transmit: bool,
        /// Condition for its value.
        comparison: Comparison,
    },
    /// Error state of the CAN controller on a real line.
    Controller(ErrorState),
    /// A value of the cable, or of the device's clock.
    Cable(Measure, Comparison),
    /// The state of a node, as the master on the bench sees it.
    Master(NodeId, Wanted),
}

/// Result of looking at a condition: whether it holds, and the present value.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Evaluation {
    pub(crate) holds: bool,
    pub(crate) now: String,
}

/// The first words of conditions, for messages.
pub(crate) const NAMES: &str = "value, saved, state, led, node-id, bitrate, turned, rpm, broken, pin, terminators, tec, rec, controller, line-length, sample-point, sjw, clock, master";

impl Fact {
    /// Reads a condition; `None` if the line begins with another word.
    pub(crate) fn parse(tokens: &mut Tokens<'_>) -> Result<Option<Self>, Problem> {
        let start = *tokens;
        Ok(Some(match tokens.next() {
            kind @ ("value" | "saved") => Self::object(kind == "value", tokens)?,
            "state" => Self::State(tokens.one_of(
                "state",
                &[
                    ("operational", Some(State::Operational)),
                    ("pre-operational", Some(State::PreOperational)),
                    ("stopped", Some(State::Stopped)),
                    ("initialising", Some(State::Initialising)),
                    ("off", None),
                ],
            )?),
            "led" => Self::Led {
                green: tokens.one_of("LED", &[("green", true), ("red", false)])?,
                led: tokens.one_of("LED state", &Led::ALL.map(|led| (led.name(), led)))?,
            },
            "node-id" => Self::NodeId(Comparison::number(tokens)?),
            "bitrate" => Self::BitRate(Comparison::number(tokens)?),
            "turned" => Self::Turned(Comparison::number(tokens)?),
            "rpm" => Self::Rpm(Comparison::number(tokens)?),
            "broken" => Self::Broken(fault_name(tokens)?),
            "pin" => {
                let here = *tokens;
                let name = tokens.next().to_owned();
                if name.is_empty() {
                    return Err(here.problem("the connection is missing", "write `pin out1 = 1`"));
                }
                Self::Pin(name, Comparison::number(tokens)?)
            }
            "terminators" => Self::Terminators(Comparison::number(tokens)?),
            counter @ ("tec" | "rec") => Self::ErrorCounter {
                transmit: counter == "tec",
                comparison: Comparison::number(tokens)?,
            },
            "controller" => Self::Controller(tokens.one_of(
                "error state",
                &[
                    ("error-active", ErrorState::ErrorActive),
                    ("error-passive", ErrorState::ErrorPassive),
                    ("bus-off", ErrorState::BusOff),
                ],
            )?),
            "line-length" => Self::Cable(Measure::Length, Comparison::number(tokens)?),
            "sample-point" => Self::Cable(Measure::SamplePoint, Comparison::number(tokens)?),
            "sjw" => Self::Cable(Measure::Jump, Comparison::number(tokens)?),
            "clock" => Self::Cable(Measure::Clock, Comparison::number(tokens)?),
            "master" => Self::Master(node(tokens)?, Wanted::parse(tokens)?),
            _ => {
                *tokens = start;
                return Ok(None);
            }
        }))
    }

    fn object(current: bool, tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let here = *tokens;
        let (object, comparison) = match tokens.split_at_sign(&SIGNS) {
            Some((object, operator)) => (object, Some(Comparison::value(operator, tokens)?)),
            None => (tokens.take_rest(), None),
        };
        let object = object.rest().to_owned();
        match (current, comparison) {
            _ if object.is_empty() => {
                Err(here.problem("the object is missing", "write `value 1017h = 500`"))
            }
            (true, None) => Err(here.problem("the value is missing", "write `value 1017h = 500`")),
            (true, Some(comparison)) => Ok(Self::Value(object, comparison)),
            (false, comparison) => Ok(Self::Saved(object, comparison)),
        }
    }

    /// Evaluates the condition. `turns` is the position of the device's shaft when the step began.
    ///
    /// # Errors
    /// Reason why the condition can never hold: the object does not exist, or the value is invalid.
    pub(crate) fn look(
        &self,
        bus: &mut Bus,
        device: usize,
        turns: Option<f64>,
    ) -> Result<Evaluation, String> {
        let gone = || format!("device {} does not exist", device + 1);
        let now = bus.now();
        match self {
            Self::Value(object, comparison) => {
                let look = |one: &mut VirtualDevice, now| {
                    let entry = values::find(one.dictionary(), object)?;
                    let (address, data_type) = (entry.address, entry.data_type);
                    #[cfg(feature = "real")]
                    if !one.is_known(address) {
                        return evaluation(false, "not known: read the object");
                    }
                    let bytes = one.read(address, now);
                    evaluation(
                        comparison.holds(data_type, &bytes)?,
                        comparison.show(data_type, &bytes),
                    )
                };
                bus.with(device, look).ok_or_else(gone)?
            }
            Self::Saved(object, comparison) => {
                let look = |one: &mut VirtualDevice, _| {
                    let entry = values::find(one.dictionary(), object)?;
                    let (address, data_type) = (entry.address, entry.data_type);
                    let saved = one.saved();
                    let Some(bytes) = one.saved_bytes(&saved, address) else {
                        return Err(format!("{address} is not saved"));
                    };
                    let holds = match comparison {
                        Some(comparison) => comparison.holds(data_type, &bytes)?,
                        None => one.is_unsaved(&saved, address) == Some(false),
                    };
                    let now = match comparison {
                        Some(comparison) => comparison.show(data_type, &bytes),
                        None => values::show(data_type, &bytes),
                    };
                    evaluation(holds, now)
                };
                bus.with(device, look).ok_or_else(gone)?
            }
            Self::Terminators(comparison) => numbers(bus.line.terminators, comparison),
            Self::Cable(measure, comparison) => {
                numbers(bus.line.measure(device + 1, *measure), comparison)
            }
            Self::Master(node, wanted) => {
                let state = bus.boot_state(*node);
                evaluation(wanted.holds(state), Wanted::of(state).short())
            }
            Self::ErrorCounter { .. } | Self::Controller(_) if !bus.line.is_real() => {
                Err("an ideal bus line has no errors; remove `line ideal`".into())
            }
            Self::ErrorCounter {
                transmit,
                comparison,
            } => {
                let controller = bus.line.controller(device + 1);
                let counter = if *transmit {
                    controller.transmit
                } else {
                    controller.receive
                };
                numbers(counter, comparison)
            }
            Self::Controller(wanted) => {
                let is = bus.line.controller(device + 1).error_state();
                evaluation(is == *wanted, is.name())
            }
            _ => self.outside(bus.devices().get(device).ok_or_else(gone)?, now, turns),
        }
    }

    /// Evaluates a condition that needs no view into the device.
    fn outside(
        &self,
        one: &VirtualDevice,
        now: od_runtime::Instant,
        turns: Option<f64>,
    ) -> Result<Evaluation, String> {
        let shaft = || -> Result<ShaftView, String> {
            one.shaft(now).ok_or("this device has no shaft".into())
        };
        match self {
            Self::State(wanted) => {
                let state = one.is_powered().then(|| one.state());
                evaluation(state == *wanted, state_name(state))
            }
            Self::Led { green, led } => {
                if !one.has_leds() {
                    return Err("this device has no LED".into());
                }
                let leds = one.leds();
                let is = if *green { leds.0 } else { leds.1 };
                evaluation(is == *led, is.name())
            }
            Self::NodeId(comparison) => numbers(one.node_id().raw(), comparison),
            Self::BitRate(comparison) => match one.bit_rate() {
                Some(rate) => numbers(rate, comparison),
                None => Err("this device has no bit rate of its own".into()),
            },
            Self::Turned(comparison) => {
                let now = shaft()?.turns;
                numbers((now - turns.unwrap_or(now)).abs(), comparison)
            }
            Self::Rpm(comparison) => numbers(shaft()?.rpm, comparison),
            Self::Broken(name) => {
                if !one.faults().contains(name) {
                    return Err(format!("this device does not support the fault `{name}`"));
                }
                let broken = one.is_broken(name);
                evaluation(broken, if broken { "active" } else { "not active" })
            }
            Self::Pin(name, comparison) => {
                let number = one.pin_named(name)?;
                numbers(one.pin(number, now) as f64, comparison)
            }
            // Handled above.
            Self::Value(..)
            | Self::Saved(..)
            | Self::Terminators(_)
            | Self::ErrorCounter { .. }
            | Self::Controller(_)
            | Self::Cable(..)
            | Self::Master(..) => evaluation(false, ""),
        }
    }

    /// The condition in words. `whose` follows its subject, as in ` of device left`; `not` negates
    /// it.
    pub(crate) fn words(&self, device: Option<&VirtualDevice>, whose: &str, not: bool) -> String {
        let is = if not { "is not" } else { "is" };
        let label = |object: &String| {
            let entry = device.map(|one| (one, values::find(one.dictionary(), object)));
            match entry {
                Some((one, Ok(entry))) => values::label(one.dictionary(), entry.address),
                _ => object.clone(),
            }
        };
        match self {
            Self::Value(object, comparison) => {
                format!("{}{whose} {is} {}", label(object), comparison.words())
            }
            Self::Saved(object, comparison) => {
                let value = comparison
                    .as_ref()
                    .map_or("the current value".into(), Comparison::words);
                format!("the saved value of {}{whose} {is} {value}", label(object))
            }
            Self::State(state) => format!("the NMT state{whose} {is} {}", state_name(*state)),
            Self::Led { green, led } => {
                let colour = if *green { "green" } else { "red" };
                format!("the {colour} LED{whose} {is} {}", led.name())
            }
            Self::NodeId(comparison) => format!("the node ID{whose} {is} {}", comparison.words()),
            Self::BitRate(comparison) => {
                format!("the bit rate{whose} {is} {} kbit/s", comparison.words())
            }
            Self::Turned(comparison) => {
                let has = if not { "has not" } else { "has" };
                format!(
                    "the shaft{whose} {has} turned by {} revolutions",
                    comparison.words()
                )
            }
            Self::Rpm(comparison) => format!("the speed{whose} {is} {} rpm", comparison.words()),
            Self::Broken(name) => format!("the fault {name}{whose} {is} active"),
            Self::Pin(name, comparison) => {
                format!("the connection {name}{whose} {is} {}", comparison.words())
            }
            Self::Terminators(comparison) => {
                format!("the number of terminators is {}", comparison.words())
            }
            Self::ErrorCounter {
                transmit,
                comparison,
            } => {
                let which = if *transmit { "transmit" } else { "receive" };
                format!(
                    "the {which} error counter{whose} {is} {}",
                    comparison.words()
                )
            }
            Self::Cable(measure, comparison) => {
                let what = match measure {
                    Measure::Length => "the length of the line in metres",
                    Measure::SamplePoint => "the sample point in percent",
                    Measure::Jump => "the synchronisation jump width",
                    Measure::Clock => "the deviation of the clock in percent",
                };
                let whose = if *measure == Measure::Clock {
                    whose
                } else {
                    ""
                };
                format!("{what}{whose} {is} {}", comparison.words())
            }
            Self::Master(node, wanted) if not => {
                format!(
                    "for the master it is not so that node {node} {}",
                    wanted.words()
                )
            }
            Self::Master(node, wanted) => format!("for the master, node {node} {}", wanted.words()),
            Self::Controller(state) => {
                format!("the CAN controller{whose} {is} {}", state.name())
            }
        }
    }
}

fn state_name(state: Option<State>) -> &'static str {
    state.map_or("off", State::name)
}

fn evaluation(holds: bool, now: impl Into<String>) -> Result<Evaluation, String> {
    let now = now.into();
    Ok(Evaluation { holds, now })
}

fn numbers(value: impl Into<f64>, comparison: &Comparison) -> Result<Evaluation, String> {
    let value = value.into();
    // A user can see a thousandth of a revolution on a shaft.
    let shown = (value * 1000.0).round() / 1000.0;
    evaluation(comparison.holds_number(value), format!("{shown}"))
}
