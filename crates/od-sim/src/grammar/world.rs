//! Lines about everything outside the bus: devices, their shafts and switches, faults, the bus line.

use std::format;
use std::prelude::v1::*;

use od_runtime::{BusEvent, NodeId};

use super::action::{Action, NewDevice};
use super::deed::{Deed, LineChange, ShaftChange};
use super::problem::Problem;
use super::size;
use super::tokens::{Tokens, fault_name};
use crate::line::cable::{self, Property};

pub(super) fn device(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let head = tokens.split_at_word(&["node", "serial", "domain-size", "as", "on", "off"]);
    let shown = head.rest();
    let name = shown.trim_matches('"');
    if name.is_empty() {
        return Err(tokens.wrong("the device name is missing"));
    }
    if shown.contains(char::is_whitespace) && !shown.starts_with('"') {
        return Err(head.problem(
            "a device name with blanks needs quotes",
            "write `device \"my device.eds\"`",
        ));
    }
    let mut added = NewDevice {
        name: Some(name.to_owned()),
        ..NewDevice::default()
    };
    while !tokens.is_empty() {
        if tokens.take("node") {
            // One node ID for each channel.
            added.nodes.clear();
            while added.nodes.is_empty() || tokens.at_number() {
                let id = tokens.number(1, 127)? as u8;
                added.nodes.extend(NodeId::new(id));
            }
        } else if tokens.take("serial") {
            added.serial = Some(tokens.number(0, u64::from(u32::MAX))? as u32);
        } else if tokens.take("domain-size") {
            let start = *tokens;
            added.domain_size = Some(size::parse(tokens.next()).ok_or_else(|| {
                start.problem(
                    "the size is missing or wrong",
                    "write a number of bytes, such as 1025, 64KiB or 1MiB",
                )
            })?);
        } else if tokens.take("as") {
            added.label = Some(label(tokens)?);
        } else if tokens.take("on") {
            added.beside = Some(label(tokens)?);
        } else if tokens.take("off") {
            added.off = true;
        } else {
            return Err(tokens.wrong(format!("unexpected `{}`", tokens.peek())));
        }
    }
    Ok(Action::Device(added))
}

pub(super) fn label(tokens: &mut Tokens<'_>) -> Result<String, Problem> {
    match tokens.next() {
        "" => Err(tokens.problem(
            "the name of a device is missing",
            "write the name after `as` in its `device` line",
        )),
        label => Ok(label.to_owned()),
    }
}

pub(super) fn shaft(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let start = *tokens;
    let what = tokens.next();
    let here = *tokens;
    let moves = |shaft| Ok(Action::Deed(Deed::Shaft(shaft)));
    if what == "at" {
        return moves(ShaftChange::At(tokens.number(0, u64::MAX)?));
    }
    if !matches!(what, "turn" | "rpm" | "ramp") {
        return Err(start.wrong(format!("a shaft cannot `{what}`")));
    }
    let number = tokens.next().parse().ok();
    let Some(value) = number.filter(|value: &f64| value.is_finite()) else {
        return Err(here.wrong("the number is missing"));
    };
    // The limits of an encoder's counters are within these: 2²⁹ revolutions with a gear, 2³¹ steps per
    // second. An angle is limited to 2³¹ revolutions, a speed to 2³¹ thousandths.
    let limit = if what == "turn" { 1e9 } else { 2e6 };
    if value.abs() > limit {
        let help = format!("the limit is {limit}");
        return Err(here.problem("the value is too large for a shaft", help));
    }
    if what == "turn" {
        return moves(ShaftChange::Turn(value));
    }
    if what == "rpm" {
        return moves(ShaftChange::Rpm(value));
    }
    if !tokens.take("over") {
        return Err(tokens.wrong("`over` is missing"));
    }
    let here = *tokens;
    let micros = tokens.duration()?;
    if micros > u64::from(u32::MAX) {
        return Err(here.problem("the ramp is too long", "the limit is 4294s"));
    }
    moves(ShaftChange::Ramp(value, micros))
}

pub(super) fn power(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let table = [("on", 0), ("off", 1), ("cycle", 2)];
    Ok(Action::Deed(
        match tokens.one_of("power state", &table)? {
            0 => Deed::Power(true),
            1 => Deed::Power(false),
            _ if tokens.is_empty() => Deed::Cycle(0),
            _ => Deed::Cycle(tokens.duration()?),
        },
    ))
}

pub(super) fn switch(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    Ok(Action::Deed(match tokens.next() {
        "node" => Deed::NodeSwitch(tokens.number(0, 99)? as u8),
        "bitrate" => Deed::RateSwitch(tokens.number(0, 7)? as u8),
        word => return Err(here.wrong(format!("switch `{word}` does not exist"))),
    }))
}

pub(super) fn fault(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let name = fault_name(tokens)?;
    let on = match tokens.next() {
        "on" => true,
        "off" => false,
        _ => return Err(tokens.wrong("`on` or `off` is missing")),
    };
    Ok(Action::Deed(Deed::Fault(name, on)))
}

pub(super) fn emcy(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let code = tokens.number(0, 0xFFFF)? as u16;
    if code == 0 || tokens.take("off") {
        return Ok(Action::Deed(Deed::ClearError(code)));
    }
    let (mut register, mut info) = (od_wire::emcy::register(code), None);
    while !tokens.is_empty() {
        if tokens.take("register") {
            register = tokens.number(0, 0xFF)? as u8;
        } else if tokens.take("info") {
            info = Some(bytes(tokens)?);
        } else {
            return Err(tokens.wrong(format!("unexpected `{}`", tokens.peek())));
        }
    }
    Ok(Action::Deed(Deed::RaiseError {
        code,
        register,
        info,
    }))
}

/// Reads one to five bytes in hexadecimal; the others are 0.
fn bytes(tokens: &mut Tokens<'_>) -> Result<[u8; 5], Problem> {
    let mut bytes = [0; 5];
    for (at, byte) in bytes.iter_mut().enumerate() {
        let word = tokens.peek();
        match u8::from_str_radix(word, 16) {
            Ok(written) if word.len() == 2 => *byte = written,
            _ if at > 0 => break,
            _ => return Err(tokens.problem("the bytes are missing", "write `info 01 02`")),
        }
        tokens.next();
    }
    Ok(bytes)
}

pub(super) fn pin(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let name = connection(tokens)?;
    let here = *tokens;
    match tokens.next().parse() {
        Ok(value) => Ok(Action::Deed(Deed::Pin(name, value))),
        Err(_) => Err(here.wrong("the value of the input is missing")),
    }
}

pub(super) fn connect(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let from = connection(tokens)?;
    let to = connection(tokens)?;
    Ok(Action::Deed(Deed::Connect(from, to)))
}

fn connection(tokens: &mut Tokens<'_>) -> Result<String, Problem> {
    let here = *tokens;
    match tokens.next() {
        "" => Err(here.wrong("the name of a connection is missing")),
        name => Ok(name.to_owned()),
    }
}

pub(super) fn bus(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    Ok(Action::Deed(match tokens.next() {
        "active" => Deed::Controller(BusEvent::Active),
        "warning" => Deed::Controller(BusEvent::Warning),
        "passive" => Deed::Controller(BusEvent::Passive),
        "off" => Deed::Controller(BusEvent::Off),
        "overrun" => Deed::Controller(BusEvent::Overrun),
        "bitrate" => Deed::BusRate(bit_rate(tokens)?),
        word => return Err(here.wrong(format!("a bus cannot `{word}`"))),
    }))
}

pub(super) fn line(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    Ok(Action::Deed(Deed::Line(match tokens.next() {
        "real" => LineChange::Real(true),
        "ideal" => LineChange::Real(false),
        "terminators" => LineChange::Terminators(tokens.number(0, 4)? as u8),
        "bitrate" => LineChange::BitRate(bit_rate(tokens)?),
        "plug" => LineChange::Plugged(true),
        "unplug" => LineChange::Plugged(false),
        "length" => LineChange::Cable(Property::Length(
            tokens.number(0, cable::LONGEST.into())? as u16
        )),
        "sample-point" => {
            let thousandths = percent(tokens, (50.0, 95.0))? * 10.0;
            LineChange::Cable(Property::SamplePoint(thousandths.round() as u16))
        }
        "sjw" => LineChange::Cable(Property::Jump(
            tokens.number(1, cable::MOST_JUMP.into())? as u8
        )),
        "clock" => {
            let millionths = percent(tokens, (-5.0, 5.0))? * 10_000.0;
            LineChange::Cable(Property::Clock(millionths.round() as i32))
        }
        "short" => LineChange::Cable(Property::Shorted(!tokens.take("off"))),
        "restart" => LineChange::Restarted,
        word => return Err(here.wrong(format!("a line cannot `{word}`"))),
    })))
}

/// Reads a number of percent in a range, without the sign.
fn percent(tokens: &mut Tokens<'_>, (low, high): (f64, f64)) -> Result<f64, Problem> {
    let here = *tokens;
    let word = tokens.next();
    let value = word
        .parse()
        .ok()
        .filter(|value| (low..=high).contains(value));
    value.ok_or_else(|| {
        let message = match word {
            "" => String::from("a number is missing"),
            _ => format!("`{word}` is not valid"),
        };
        here.problem(
            message,
            format!("write a percentage from {low} to {high}, such as {high}"),
        )
    })
}

/// Reads a bit rate in kbit/s, or `any`.
fn bit_rate(tokens: &mut Tokens<'_>) -> Result<Option<u16>, Problem> {
    if tokens.take("any") {
        Ok(None)
    } else {
        Ok(Some(tokens.number(1, 1000)? as u16))
    }
}
