//! From text to statements. Every line stands for itself, so every mistake is found.

use std::prelude::v1::*;
use std::{format, vec};

use od_runtime::{BusEvent, Instant, NodeId};
use od_wire::nmt::Command;

use super::parse_expect::{expect, repeated, sdo};
use super::statement::{Action, Power, Shaft, Statement, Timing, When, Wire};
use super::words::{Words, is_decimal};
use super::{Pattern, Problem, Script};
use crate::faults;
use crate::logs::candump;

/// A log of the wall clock counts from 1970; its first stamp is taken as the origin.
const WALL_CLOCK: u64 = 100_000_000_000_000;

const STATEMENTS: &str = "a line is a frame (601#4004600000000000), or begins with device, use, \
                          shaft, power, switch, fault, bus, line, wait, at, after, send, nmt, sync, sdo, \
                          ignore, skip or expect";

/// Reads a script whose first line has this number in its file.
pub(super) fn parse(text: &str, first: u32) -> Result<Script, Vec<Problem>> {
    let mut script = Script::default();
    let mut problems = vec![];
    let mut origin = None;
    for (line, text) in (first..).zip(text.lines()) {
        let words = Words::new(line, text.strip_prefix('\u{feff}').unwrap_or(text));
        if words.is_empty() {
            continue;
        }
        let shown = words.rest().to_owned();
        match statement(words, &mut origin) {
            Ok((when, action)) => {
                script.statements.push(Statement {
                    line,
                    text: shown,
                    when,
                    action,
                });
            }
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() {
        Ok(script)
    } else {
        Err(problems)
    }
}

impl super::Reader {
    /// Reads one more line.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(&mut self, text: &str) -> Result<Script, Problem> {
        self.line = self.line.saturating_add(1);
        let words = Words::new(self.line, text.trim_start_matches('\u{feff}'));
        let mut script = Script::default();
        if !words.is_empty() {
            let shown = words.rest().to_owned();
            let (when, action) = statement(words, &mut self.origin)?;
            script.statements.push(Statement {
                line: self.line,
                text: shown,
                when,
                action,
            });
        }
        Ok(script)
    }
}

pub(super) fn statement(
    mut words: Words<'_>,
    origin: &mut Option<u64>,
) -> Result<(When, Action), Problem> {
    let when = time(&mut words, origin)?;
    if words.is_empty() && when != When::Next {
        return Ok((when, Action::Wait));
    }
    let start = words;
    let action = match words.next() {
        "device" => device(&mut words)?,
        "use" => Action::Use(label(&mut words)?),
        "shaft" => shaft(&mut words)?,
        "power" => power(&mut words)?,
        "switch" => switch(&mut words)?,
        "fault" => fault(&mut words)?,
        "bus" => bus(&mut words)?,
        "line" => wire(&mut words)?,
        "wait" => {
            let micros = words.duration()?;
            words.end()?;
            return match when {
                When::Next => Ok((When::After(micros), Action::Wait)),
                _ => Err(start.problem("a time and a wait", "write one of the two")),
            };
        }
        "send" => send(&mut words)?,
        "nmt" => nmt(&mut words)?,
        "sync" => sync(&mut words)?,
        "sdo" => sdo(&mut words)?,
        "ignore" => ignore(&mut words)?,
        "skip" => Action::Skip,
        "expect" => Action::Expect(expect(&mut words)?),
        word => {
            let looks_like_a_frame =
                word.contains('#') || words.peek().contains('#') || words.rest().contains('[');
            if !looks_like_a_frame {
                return Err(start.problem(format!("`{word}` begins no statement"), STATEMENTS));
            }
            words = start;
            frame(&mut words)?
        }
    };
    words.end()?;
    Ok((when, action))
}

/// `(0.100000)`, `at 1.5s`, `after 100ms`, or nothing.
fn time(words: &mut Words<'_>, origin: &mut Option<u64>) -> Result<When, Problem> {
    if words.take("at") {
        return words
            .duration()
            .map(|micros| When::At(Instant::from_micros(micros)));
    }
    if words.take("after") {
        return words.duration().map(When::After);
    }
    if !words.peek().starts_with('(') {
        return Ok(When::Next);
    }
    let here = *words;
    let stamp = words.next();
    let inner = stamp
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'));
    let micros = match inner {
        Some(inner) if is_decimal(inner) => match candump::seconds(inner) {
            Some(micros) => micros,
            None => return here.limited(None).map(|_| When::Next),
        },
        _ => {
            let message = format!("`{stamp}` is no time stamp");
            return Err(here.problem(message, "write seconds in parentheses, like (0.100000)"));
        }
    };
    let first = *origin.get_or_insert(if micros >= WALL_CLOCK { micros } else { 0 });
    here.limited(Some(micros.saturating_sub(first)))
        .map(|micros| When::At(Instant::from_micros(micros)))
}

/// A line of a log, or a frame as `cansend` takes it, blanks between its bytes allowed.
fn frame(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    let frame = match words.peek().contains('#') {
        true => candump::parse_frame(words.rest()),
        false => candump::parse_line(words.rest()).map(|line| line.frame),
    };
    *words = Words::new(0, "");
    match frame {
        Ok(frame) => Ok(Action::Send {
            frame,
            times: 1,
            every: 0,
        }),
        Err(error) => Err(here.frame_problem(&error)),
    }
}

/// `send 080# 3 times every 10ms`.
fn send(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    let (head, times, timing) = repeated(words)?;
    let every = match timing {
        Timing::Now => 0,
        Timing::Every(micros) => micros,
        _ => return Err(words.problem("a sent frame has no such time", "write `every 10ms`")),
    };
    here.limited_turns(times, every)?;
    match candump::parse_frame(head.rest()) {
        Ok(frame) => Ok(Action::Send {
            frame,
            times,
            every,
        }),
        Err(error) => Err(head.frame_problem(&error)),
    }
}

fn device(words: &mut Words<'_>) -> Result<Action, Problem> {
    const HELP: &str = "write `device gxmm`, `device gxmm node 5 as left`, or a file name";
    let head = words.split_at_word(&["node", "serial", "as", "on", "off"]);
    let shown = head.rest();
    let name = shown.trim_matches('"').to_owned();
    if name.is_empty() {
        return Err(words.problem("a device name is missing", HELP));
    }
    if shown.contains(char::is_whitespace) && !shown.starts_with('"') {
        return Err(head.problem("a name with blanks stands in quotes", HELP));
    }
    let (mut nodes, mut name_of, mut beside, mut powered) = (Vec::new(), None, None, true);
    let mut serial = None;
    while !words.is_empty() {
        if words.take("node") {
            // One for each channel.
            nodes.clear();
            while nodes.is_empty() || words.at_number() {
                nodes.extend(NodeId::new(words.number(1, 127)? as u8));
            }
        } else if words.take("serial") {
            serial = Some(words.number(0, u64::from(u32::MAX))? as u32);
        } else if words.take("as") {
            name_of = Some(label(words)?);
        } else if words.take("on") {
            beside = Some(label(words)?);
        } else if words.take("off") {
            powered = false;
        } else {
            return Err(words.problem(format!("`{}` is unknown", words.peek()), HELP));
        }
    }
    Ok(Action::Device {
        name,
        nodes,
        label: name_of,
        beside,
        serial,
        powered,
    })
}

fn label(words: &mut Words<'_>) -> Result<String, Problem> {
    match words.next() {
        "" => Err(words.problem(
            "a name is missing",
            "name the device of a `device … as name` line",
        )),
        label => Ok(label.to_owned()),
    }
}

fn shaft(words: &mut Words<'_>) -> Result<Action, Problem> {
    const HELP: &str = "write `shaft at 0x79592` (raw steps), `shaft turn 2.5`, `shaft rpm 60` or \
                        `shaft ramp 6000 over 1s`";
    let what = words.next();
    let here = *words;
    if what == "at" {
        return words
            .number(0, u64::MAX)
            .map(|raw| Action::Shaft(Shaft::At(raw)));
    }
    let number = words
        .next()
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite());
    // Far and fast enough for the ends of what an encoder counts: 2²⁹ revolutions with a gear,
    // 2³¹ steps a second. An angle ends at 2³¹ revolutions, a speed at 2³¹ thousandths.
    let limit = if what == "turn" { 1e9 } else { 2e6 };
    if number.is_some_and(|value| value.abs() > limit) {
        let help = format!("the limit is {limit}");
        return Err(here.problem("a shaft does not turn so far or so fast", help));
    }
    match (what, number) {
        ("turn", Some(turns)) => Ok(Action::Shaft(Shaft::Turn(turns))),
        ("rpm", Some(rpm)) => Ok(Action::Shaft(Shaft::Rpm(rpm))),
        ("ramp", Some(rpm)) if words.take("over") => {
            let here = *words;
            let micros = words.duration()?;
            if micros > u64::from(u32::MAX) {
                return Err(here.problem("a ramp is too long", "the limit is 4294s"));
            }
            Ok(Action::Shaft(Shaft::Ramp(rpm, micros)))
        }
        ("ramp", Some(_)) => Err(words.problem("`over` is missing", HELP)),
        ("turn" | "rpm" | "ramp", None) => Err(here.problem("a number is missing", HELP)),
        _ => Err(here.problem(format!("a shaft cannot `{what}`"), HELP)),
    }
}

fn power(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    Ok(Action::Power(match words.next() {
        "on" => Power::On,
        "off" => Power::Off,
        "cycle" if words.is_empty() => Power::Cycle(0),
        "cycle" => Power::Cycle(words.duration()?),
        word => {
            let message = format!("power cannot be `{word}`");
            return Err(here.problem(message, "write `power on`, `power off` or `power cycle 2s`"));
        }
    }))
}

fn switch(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    match words.next() {
        "node" => words
            .number(0, 99)
            .map(|number| Action::SwitchNode(number as u8)),
        "bitrate" => words
            .number(0, 7)
            .map(|number| Action::SwitchBitrate(number as u8)),
        word => Err(here.problem(
            format!("there is no switch `{word}`"),
            "write `switch node 12` (rotary, 0: EEPROM) or `switch bitrate 5` (DIP, 0 to 7)",
        )),
    }
}

fn fault(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    let name = words.next();
    if !faults::NAMES.contains(&name) {
        let help = format!("there are {}", faults::NAMES.join(", "));
        return Err(here.problem(format!("there is no fault `{name}`"), help));
    }
    let on = match words.next() {
        "on" => true,
        "off" => false,
        _ => return Err(words.problem("`on` or `off` is missing", "write `fault battery-low on`")),
    };
    Ok(Action::Fault {
        name: name.to_owned(),
        on,
    })
}

fn bus(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    match words.next() {
        "active" => Ok(Action::Bus(BusEvent::Active)),
        "warning" => Ok(Action::Bus(BusEvent::Warning)),
        "passive" => Ok(Action::Bus(BusEvent::Passive)),
        "off" => Ok(Action::Bus(BusEvent::Off)),
        "overrun" => Ok(Action::Bus(BusEvent::Overrun)),
        "bitrate" if words.take("any") => Ok(Action::BusRate(None)),
        "bitrate" => words
            .number(1, 1000)
            .map(|kbit| Action::BusRate(Some(kbit as u16))),
        word => Err(here.problem(
            format!("a bus cannot `{word}`"),
            "there are bus active, warning, passive, off, overrun, bitrate 250 (kbit/s) and \
             bitrate any",
        )),
    }
}

fn wire(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    Ok(Action::Line(match words.next() {
        "real" => Wire::Real(true),
        "ideal" => Wire::Real(false),
        "terminators" => Wire::Terminators(words.number(0, 4)? as u8),
        "bitrate" if words.take("any") => Wire::BitRate(None),
        "bitrate" => Wire::BitRate(Some(words.number(1, 1000)? as u16)),
        "plug" => Wire::Plugged(true),
        "unplug" => Wire::Plugged(false),
        word => {
            return Err(here.problem(
                format!("a line cannot `{word}`"),
                "there are line real, ideal, terminators 2, bitrate 250 (kbit/s), bitrate any, \
                 plug and unplug",
            ));
        }
    }))
}

fn nmt(words: &mut Words<'_>) -> Result<Action, Problem> {
    let command = command(words)?;
    let node = match words.is_empty() {
        true => None,
        false if words.take("all") => Some(0),
        false => Some(words.number(0, 127)? as u8),
    };
    Ok(Action::Nmt { command, node })
}

/// The name of an NMT command.
pub(crate) fn command(words: &mut Words<'_>) -> Result<Command, Problem> {
    let here = *words;
    Ok(match words.next() {
        "start" => Command::Start,
        "stop" => Command::Stop,
        "preop" => Command::EnterPreOperational,
        "reset" => Command::ResetNode,
        "reset-comm" => Command::ResetCommunication,
        word => {
            let message = format!("there is no NMT command `{word}`");
            return Err(here.problem(message, "there are start, stop, preop, reset, reset-comm"));
        }
    })
}

fn sync(words: &mut Words<'_>) -> Result<Action, Problem> {
    let here = *words;
    let mut frame = od_runtime::Frame::standard(0x80, &[]);
    let (mut times, mut every) = (1, 0);
    if words.take("counter") {
        frame = od_runtime::Frame::standard(0x80, &[words.number(1, 240)? as u8]);
    }
    if words.at_number() {
        times = words.number(1, 1_000_000)? as u32;
        if !words.take("times") {
            return Err(words.problem("`times` is missing", "write `sync 15 times every 10ms`"));
        }
    }
    if words.take("every") {
        every = words.duration()?;
    }
    here.limited_turns(times, every)?;
    Ok(Action::Send {
        frame,
        times,
        every,
    })
}

fn ignore(words: &mut Words<'_>) -> Result<Action, Problem> {
    if words.take("nothing") {
        return Ok(Action::IgnoreNothing);
    }
    let head = words.split_at_word(&[]);
    match Pattern::parse(head.rest()) {
        Ok(pattern) => Ok(Action::Ignore(pattern)),
        Err(error) => Err(head.frame_problem(&error)),
    }
}

#[cfg(test)]
mod tests;
