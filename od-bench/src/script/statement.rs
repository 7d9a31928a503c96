//! What the lines of a script say.

use std::prelude::v1::*;

use od_runtime::{AbortCode, BusEvent, Frame, Instant, NodeId};
use od_wire::nmt::Command;

use super::Pattern;
use crate::device::VirtualDevice;
use crate::leds::Led;
use crate::wire::Line;

/// When a line acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum When {
    /// When the line before it is done.
    Next,
    /// At a moment.
    At(Instant),
    /// So many microseconds after the line before it.
    After(u64),
}

/// Which direction and how far.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Shaft {
    /// To a raw position.
    At(u64),
    /// By turns, backwards if negative.
    Turn(f64),
    /// Turns from now on, revolutions a minute.
    Rpm(f64),
    /// To so many revolutions a minute, evenly, in so many microseconds.
    Ramp(f64, u64),
}

impl Shaft {
    /// Turns the shaft of a device; answers whether it has one.
    pub(super) fn act(self, device: &mut VirtualDevice, now: Instant) -> bool {
        match self {
            Self::At(raw) => device.set_position(raw, now),
            Self::Turn(turns) => device.turn(turns, now),
            Self::Rpm(rpm) => device.set_rpm(rpm, now),
            Self::Ramp(rpm, micros) => device.ramp_to_rpm(rpm, micros, now),
        }
    }
}

/// What happens to the supply.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Power {
    On,
    Off,
    /// Off for so many microseconds, then on.
    Cycle(u64),
}

/// What becomes of the wire.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Wire {
    /// Can frames fail?
    Real(bool),
    /// Resistors at its ends.
    Terminators(u8),
    /// Bit rate of what is outside in kbit/s; `None`: that of the first device.
    BitRate(Option<u16>),
    /// The present device hangs on it.
    Plugged(bool),
}

impl Wire {
    /// Changes the line that a device, counted from 0, hangs on.
    pub(super) fn act(self, line: &mut Line, device: usize) {
        match self {
            Self::Real(real) => line.is_real = real,
            Self::Terminators(count) => line.terminators = count,
            Self::BitRate(kbit) => line.bit_rate = kbit,
            Self::Plugged(plugged) => line.set_plugged(device + 1, plugged),
        }
    }
}

/// When an expected frame has to come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Timing {
    /// It is there already.
    Now,
    /// Within so many microseconds.
    Within(u64),
    /// After exactly so many microseconds.
    After(u64),
    /// Each after exactly so many microseconds from the one before.
    Every(u64),
}

/// What has to hold.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Expect {
    Frame {
        pattern: Pattern,
        times: u32,
        timing: Timing,
    },
    Abort {
        code: AbortCode,
        timing: Timing,
    },
    Silence(u64),
    State(String),
    Value {
        object: String,
        value: String,
    },
    Led {
        green: bool,
        led: Led,
    },
    /// In kbit/s.
    BitRate(u16),
}

/// How an SDO transfer has to end.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Outcome {
    Done,
    Value(String),
    Aborts(AbortCode),
}

/// What a line does.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Action {
    Device {
        name: String,
        /// Of each channel.
        nodes: Vec<NodeId>,
        label: Option<String>,
        /// The device on whose shaft it sits.
        beside: Option<String>,
        /// Another serial number than the first.
        serial: Option<u32>,
        powered: bool,
    },
    Use(String),
    Send {
        frame: Frame,
        times: u32,
        every: u64,
    },
    Shaft(Shaft),
    Power(Power),
    SwitchNode(u8),
    SwitchBitrate(u8),
    Fault {
        name: String,
        on: bool,
    },
    /// Bit rate of what is outside in kbit/s; `None`: it does not matter.
    BusRate(Option<u16>),
    /// News of the CAN controller.
    Bus(BusEvent),
    /// The wire changes.
    Line(Wire),
    Wait,
    Nmt {
        command: Command,
        node: Option<u8>,
    },
    Read {
        object: String,
        outcome: Outcome,
    },
    Write {
        object: String,
        value: String,
        type_name: Option<String>,
        outcome: Outcome,
    },
    Ignore(Pattern),
    IgnoreNothing,
    Skip,
    Expect(Expect),
}

/// One line with its place in the text.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Statement {
    pub(super) line: u32,
    pub(super) text: String,
    pub(super) when: When,
    pub(super) action: Action,
}
