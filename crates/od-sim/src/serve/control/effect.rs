//! Describes the effect of a line in words.

use od_model::values;
use od_runtime::BusEvent;
use od_wire::nmt::State;

use crate::bench::Bench;
use crate::device::VirtualDevice;
use crate::grammar::deed::{Deed, LineChange, ShaftChange};
use crate::grammar::duration::duration;
use crate::words::{emcy_text, value_text};

/// The effect of an action, on the bench as it is now.
pub(super) fn effect(deed: &Deed, bench: &Bench) -> String {
    let Ok(device) = bench.present() else {
        return String::from("done");
    };
    let name = if device.is_configured() {
        format!("node {}", device.node_id())
    } else {
        format!("device {}", bench.current + 1)
    };
    let effect = match deed {
        Deed::Wait => return String::from("waited"),
        Deed::Use(_) => return format!("the next lines are about {name} ({})", device.title()),
        Deed::Send { frame, times, .. } => {
            let frame = frame.of(device).map(|frame| frame.to_string());
            let frame = frame.unwrap_or_default();
            return match times {
                1 => format!("{frame} sent"),
                times => format!("{frame} sent {times} times"),
            };
        }
        Deed::BusRate(None) => return String::from("all bit rates match"),
        Deed::BusRate(Some(kbit)) => return format!("masters use {kbit} kbit/s"),
        Deed::Line(LineChange::Plugged(true)) => String::from("connected to the bus line"),
        Deed::Line(LineChange::Plugged(false)) => String::from("disconnected from the bus line"),
        Deed::Line(change) => return line(*change),
        Deed::Master(_) => return String::from("the master has the line"),
        Deed::Power(true) => String::from("power on"),
        Deed::Power(false) => String::from("power off"),
        Deed::Cycle(micros) => format!("power off for {}, then on", duration(*micros)),
        Deed::Shaft(shaft) => match shaft {
            ShaftChange::At(raw) => format!("shaft at raw position {raw}"),
            ShaftChange::Turn(turns) => format!("shaft turned, in revolutions: {turns}"),
            ShaftChange::Rpm(rpm) => format!("shaft at {rpm} rpm"),
            ShaftChange::Ramp(rpm, micros) => {
                format!("shaft to {rpm} rpm over {}", duration(*micros))
            }
        },
        Deed::NodeSwitch(number) => format!("rotary switches at {number:02} from the next start"),
        Deed::RateSwitch(number) => format!("DIP switches at {number} from the next start"),
        Deed::Fault(name, true) => format!("fault {name} on"),
        Deed::Fault(name, false) => format!("fault {name} off"),
        Deed::RaiseError { code, register, .. } => {
            let text = emcy_text(*code, Some(device));
            let silent = match device.state() {
                State::Stopped => "; a node in Stopped sends no EMCY message",
                _ => "",
            };
            format!("error {code:04X}h ({text}), error register {register:02X}h{silent}")
        }
        Deed::ClearError(0) => String::from("all errors of `emcy` lines off"),
        Deed::ClearError(code) => format!("error {code:04X}h off"),
        Deed::Set(write) => match write.own(device.dictionary()) {
            Ok((address, bytes)) => value(device, address, &bytes),
            Err(_) => String::from("value set"),
        },
        Deed::Pin(name, number) => format!("{name} = {number}"),
        Deed::Connect(from, to) => return format!("{from} is wired to {to}"),
        Deed::Controller(event) => String::from(match event {
            BusEvent::Active => "CAN controller error active",
            BusEvent::Warning => "CAN controller at its warning limit",
            BusEvent::Passive => "CAN controller error passive",
            BusEvent::Off => "CAN controller bus-off",
            _ => "CAN controller lost a frame",
        }),
    };
    format!("{name}: {effect}")
}

fn value(device: &VirtualDevice, address: od_model::Address, bytes: &[u8]) -> String {
    let dictionary = device.dictionary();
    let label = values::label(dictionary, address);
    match dictionary.find(address) {
        Ok(entry) => {
            let shown = value_text(device, address, entry.data_type, bytes);
            format!("{label} = {shown}")
        }
        Err(_) => label,
    }
}

fn line(change: LineChange) -> String {
    match change {
        LineChange::Real(true) => String::from("the bus line is real"),
        LineChange::Real(false) => String::from("the bus line is ideal"),
        LineChange::Terminators(1) => String::from("the bus line has 1 terminator"),
        LineChange::Terminators(count) => format!("the bus line has {count} terminators"),
        LineChange::BitRate(Some(kbit)) => format!("masters use {kbit} kbit/s on the bus line"),
        LineChange::BitRate(None) => String::from("masters use the bit rate of the first node"),
        LineChange::Restarted => String::from("masters and clients send on the bus line again"),
        LineChange::Plugged(_) | LineChange::Cable(_) => String::from("done"),
    }
}
