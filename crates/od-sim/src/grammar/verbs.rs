//! The table of verbs: the first word of a line, its syntax, and its reader.

use std::prelude::v1::*;

use super::action::{Action, Expect, Outcome, Timing};
use super::deed::Deed;
use super::fact::Fact;
use super::frames::{self, Frames};
use super::master::MasterLine;
use super::named_frame::{NamedFrame, write};
use super::pattern::Pattern;
use super::problem::Problem;
use super::tokens::{Tokens, nmt_command};
use super::world::{bus, connect, device, emcy, fault, label, line, pin, power, shaft, switch};
use crate::logs::candump;

pub(super) struct Verb {
    pub(super) name: &'static str,
    /// Syntax of its lines, for messages.
    pub(super) usage: &'static str,
    pub(super) parse: fn(&mut Tokens<'_>) -> Result<Action, Problem>,
}

/// All verbs, in the order of messages.
#[rustfmt::skip]
pub(super) const VERBS: [Verb; 23] = [
    Verb { name: "device", parse: device,
           usage: "`device gxmm`, `device gxmm node 5 as left`, or a file name" },
    Verb { name: "use", parse: |tokens| Ok(Action::Deed(Deed::Use(label(tokens)?))),
           usage: "`use left`: the name of a `device … as left` line, or the number of a device" },
    Verb { name: "shaft", parse: shaft,
           usage: "`shaft at 0x79592` (raw steps), `shaft turn 2.5`, `shaft rpm 60` or \
                   `shaft ramp 6000 over 1s`" },
    Verb { name: "power", parse: power,
           usage: "`power on`, `power off` or `power cycle 2s`" },
    Verb { name: "switch", parse: switch,
           usage: "`switch node 12` (rotary, 0: EEPROM) or `switch bitrate 5` (DIP, 0 to 7)" },
    Verb { name: "fault", parse: fault, usage: "`fault battery-low on`" },
    Verb { name: "emcy", parse: emcy,
           usage: "`emcy 4200h`, `emcy 4200h register 09h info 01 02`, `emcy 4200h off` or \
                   `emcy 0000h` (all off)" },
    Verb { name: "set", parse: set, usage: "`set 6000h:01 = 5`" },
    Verb { name: "pin", parse: pin, usage: "`pin in3 1`: an input of the device and its value" },
    Verb { name: "wire", parse: connect,
           usage: "`wire out1 in3`, or `wire left.out1 right.in3` with names of `device … as` lines" },
    Verb { name: "bus", parse: bus,
           usage: "bus active, warning, passive, off, overrun, bitrate 250 (kbit/s) or bitrate any" },
    Verb { name: "line", parse: line,
           usage: "line real, ideal, terminators 2, bitrate 250 (kbit/s), bitrate any, plug, unplug, \
                   length 100 (m), sample-point 87.5 (%), sjw 1, clock 0.5 (%), short, short off or restart" },
    Verb { name: "master", parse: |tokens| Ok(Action::Deed(Deed::Master(MasterLine::parse(tokens)?))),
           usage: "`master slave 5`, `master expect 5 1018h:02 = 10`, `master write 5 1017h = 100`, \
                   `master heartbeat 5 300ms`, `master sync 100ms`, `master boot`, `master started 5` or `master clear`" },
    Verb { name: "send", parse: send, usage: "`send 080# 3 times every 10ms`" },
    Verb { name: "nmt", parse: nmt, usage: "`nmt start`, `nmt start 5` or `nmt start all`" },
    Verb { name: "sync", parse: sync, usage: "`sync 15 times every 10ms` or `sync counter 3`" },
    Verb { name: "guard", parse: |_| Ok(once(NamedFrame::Guard)), usage: "`guard`" },
    Verb { name: "read", parse: read, usage: "`read 1017h`" },
    Verb { name: "write", parse: |tokens| Ok(once(NamedFrame::Write(write(tokens)?))),
           usage: "`write 1017h = 500`" },
    Verb { name: "sdo", parse: sdo,
           usage: "`sdo read 6004h`, `sdo read 6004h = 5` or `sdo write 6001h = 4096`; add \
                   ` aborts 06090031h` to expect an abort" },
    Verb { name: "ignore", parse: ignore, usage: "`ignore 181#*` or `ignore nothing`" },
    Verb { name: "skip", parse: |_| Ok(Action::Skip), usage: "`skip`" },
    Verb { name: "expect", parse: |tokens| expect(tokens).map(Action::Expect),
           usage: "`expect 581#43*`, `expect state operational` or `expect silence 1s`" },
];

fn once(frame: NamedFrame) -> Action {
    Action::Deed(Deed::Send {
        frame,
        times: 1,
        every: 0,
    })
}

fn send(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    let (head, times, timing) = repeated(tokens)?;
    let every = match timing {
        Timing::Now => 0,
        Timing::Every(micros) => micros,
        _ => return Err(tokens.problem("a sent frame cannot have this time", "write `every 10ms`")),
    };
    here.limited_turns(times, every)?;
    let frame = candump::parse_frame(head.rest()).map_err(|error| head.frame_problem(&error))?;
    Ok(Action::Deed(Deed::Send {
        frame: NamedFrame::Frame(frame),
        times,
        every,
    }))
}

fn nmt(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let (command, node) = nmt_command(tokens)?;
    Ok(once(NamedFrame::Nmt(command, node)))
}

fn sync(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    let mut frame = od_runtime::Frame::standard(0x80, &[]);
    let (mut times, mut every) = (1, 0);
    if tokens.take("counter") {
        frame = od_runtime::Frame::standard(0x80, &[tokens.number(1, 240)? as u8]);
    }
    if tokens.at_number() {
        times = tokens.number(1, 1_000_000)? as u32;
        if !tokens.take("times") {
            return Err(tokens.wrong("`times` is missing"));
        }
    }
    if tokens.take("every") {
        every = tokens.duration()?;
    }
    here.limited_turns(times, every)?;
    Ok(Action::Deed(Deed::Send {
        frame: NamedFrame::Frame(frame),
        times,
        every,
    }))
}

fn read(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    match tokens.take_rest().rest() {
        "" => Err(tokens.wrong("the object is missing")),
        object => Ok(once(NamedFrame::Read(object.to_owned()))),
    }
}

fn set(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    let write = write(tokens)?;
    match write.data_type {
        None => Ok(Action::Deed(Deed::Set(write))),
        Some(_) => Err(here.problem("the dictionary has the type of the value", "remove `as …`")),
    }
}

fn sdo(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    let here = *tokens;
    let kind = tokens.next();
    let mut body = tokens.split_at_word(&["aborts"]);
    let aborts = if tokens.take("aborts") {
        Some(Outcome::Aborts(frames::abort(tokens)?))
    } else {
        None
    };
    match kind {
        "write" if body.rest().contains('=') => {
            let outcome = aborts.unwrap_or(Outcome::Done);
            let write = write(&mut body)?;
            Ok(Action::Write { write, outcome })
        }
        "read" => {
            let value = body;
            let (object, outcome) = match (body.split_at_equals(), aborts) {
                (None, aborts) => (value, aborts.unwrap_or(Outcome::Done)),
                (Some(object), None) if !body.is_empty() => {
                    (object, Outcome::Value(body.rest().to_owned()))
                }
                _ => return Err(here.wrong("the SDO line is not valid")),
            };
            if object.is_empty() {
                return Err(here.wrong("the object is missing"));
            }
            let object = object.rest().to_owned();
            Ok(Action::Read { object, outcome })
        }
        _ => Err(here.wrong("the SDO line is not valid")),
    }
}

fn ignore(tokens: &mut Tokens<'_>) -> Result<Action, Problem> {
    if tokens.take("nothing") {
        return Ok(Action::Ignore(None));
    }
    let head = tokens.take_rest();
    match Pattern::parse(head.rest()) {
        Ok(pattern) => Ok(Action::Ignore(Some(pattern))),
        Err(error) => Err(head.frame_problem(&error)),
    }
}

fn expect(tokens: &mut Tokens<'_>) -> Result<Expect, Problem> {
    if tokens.take("silence") {
        return Ok(Expect::Silence(tokens.duration()?));
    }
    let here = *tokens;
    let mut rest = here;
    let mut head = rest.split_at_word(&["within"]);
    match Fact::parse(&mut head)? {
        Some(Fact::Turned(_)) => {
            let help = "`turned` works in lessons only; write `expect value 6004h = …`";
            return Err(here.problem("a script cannot expect `turned`", help));
        }
        Some(fact) => {
            head.end()?;
            *tokens = rest;
            let within = if tokens.take("within") {
                tokens.duration()?
            } else {
                0
            };
            return Ok(Expect::Fact { fact, within });
        }
        None => {}
    }
    let (mut head, times, timing) = repeated(tokens)?;
    Ok(Expect::Frame {
        frames: Frames::parse(&mut head)?,
        times,
        timing,
    })
}

/// Reads a frame, then `N times`, `within D`, `after D`, `every D`.
fn repeated<'t>(tokens: &mut Tokens<'t>) -> Result<(Tokens<'t>, u32, Timing), Problem> {
    let mut head = tokens.split_at_word(&["times", "within", "after", "every"]);
    let mut times = 1;
    if tokens.take("times") {
        times = head.split_last().number(1, 1_000_000)? as u32;
    }
    let timing = if tokens.take("within") {
        Timing::Within(tokens.duration()?)
    } else if tokens.take("after") {
        Timing::After(tokens.duration()?)
    } else if tokens.take("every") {
        Timing::Every(tokens.duration()?)
    } else {
        Timing::Now
    };
    if times == 1 && tokens.at_number() {
        times = tokens.number(1, 1_000_000)? as u32;
        if !tokens.take("times") {
            return Err(tokens.problem("`times` is missing", "write `5 times`"));
        }
    }
    Ok((head, times, timing))
}
