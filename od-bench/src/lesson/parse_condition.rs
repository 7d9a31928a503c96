//! From the lines of a checkpoint to what they ask for.

use std::format;
use std::prelude::v1::*;

use super::Problem;
use super::condition::{Alternative, Fact, Frames, How, Kind, Line, Seen, Test, What, Who};
use crate::faults;
use crate::leds::Led;
use crate::script::Pattern;
use crate::script::parse::command;
use crate::script::parse_expect::abort;
use crate::script::words::Words;
use od_model::values;

const HELP: &str = "a condition begins with sent, came, seen, value, saved, state, led, node-id, \
                    bitrate, turned, rpm, broken, quiet, undisturbed or terminators";

const STATES: [&str; 5] = [
    "pre-operational",
    "operational",
    "stopped",
    "initialising",
    "off",
];

/// One line; `None` where it says nothing. `before` is the line above it.
pub(super) fn line(
    number: u32,
    text: &str,
    before: Option<&Line>,
) -> Result<Option<Line>, Problem> {
    let mut words = Words::new(number, text);
    if words.is_empty() {
        return Ok(None);
    }
    let start = words;
    let then = words.take("then");
    let mut alternatives = Vec::new();
    let mut more = true;
    while more {
        let mut head = words.split_at_word(&["or", "--"]);
        alternatives.push(alternative(&mut head)?);
        more = words.take("or");
    }
    let say = words.take("--").then(|| words.rest().to_owned());
    if say.as_ref().is_some_and(String::is_empty) {
        return Err(words.problem("there are no words behind `--`", "say what is missing"));
    }
    let line = Line {
        line: number,
        then,
        alternatives,
        say,
    };
    let resets = |one: &Alternative| one.not && matches!(one.what, What::Seen(_));
    if line.alternatives.len() > 1 && line.alternatives.iter().any(resets) {
        let message = "`not` with a frame stands in a line of its own";
        return Err(start.problem(message, "write two lines"));
    }
    if then && !(line.waits() && before.is_some_and(Line::waits)) {
        return Err(start.problem(
            "`then` stands between two frames",
            "this line and the one above it wait for frames, with sent, came or seen",
        ));
    }
    let limited =
        |one: &Alternative| matches!(&one.what, What::Seen(seen) if seen.within.is_some());
    if !then && line.alternatives.iter().any(limited) {
        return Err(start.problem(
            "`within` needs something to count from",
            "begin the line with `then`: the time counts from the line above",
        ));
    }
    Ok(Some(line))
}

fn alternative(words: &mut Words<'_>) -> Result<Alternative, Problem> {
    let not = words.take("not");
    let here = *words;
    let who = match words.peek() {
        "sent" => Some(Who::Learner),
        "came" => Some(Who::Device),
        "seen" => Some(Who::Anybody),
        _ => None,
    };
    let what = match who {
        Some(who) => {
            words.next();
            let seen = seen(who, words)?;
            let plain = seen.times == 1 && seen.every.is_none() && seen.within.is_none();
            if not && !plain {
                let message = "a frame that must not come has no number and no time";
                return Err(here.problem(message, "write `not came 581#80*`"));
            }
            What::Seen(seen)
        }
        None => What::Fact(fact(words)?),
    };
    words.end()?;
    Ok(Alternative { not, what })
}

fn seen(who: Who, words: &mut Words<'_>) -> Result<Seen, Problem> {
    let mut head = words.split_at_word(&["times", "every", "within", "of"]);
    let (mut times, mut every, mut within, mut device) = (1, None, None, None);
    if words.take("times") {
        times = head.split_last().number(1, 100_000)? as u32;
    }
    let what = frames(&mut head)?;
    while !words.is_empty() {
        if words.take("every") {
            let low = words.duration()?;
            let high = if words.take("to") {
                words.duration()?
            } else {
                low
            };
            every = Some((low, high));
        } else if words.take("within") {
            within = Some(words.duration()?);
        } else if words.take("of") {
            device = Some(device_name(words)?);
        } else {
            // Something is left, so this is an error.
            words.end()?;
        }
    }
    if every.is_some() && times < 2 {
        return Err(words.problem(
            "`every` needs a number",
            "write `came 701#* 3 times every 500ms`",
        ));
    }
    Ok(Seen {
        who,
        what,
        device,
        times,
        every,
        within,
    })
}

fn device_name(words: &mut Words<'_>) -> Result<String, Problem> {
    match words.next() {
        "" => Err(words.problem(
            "a device is missing",
            "write its number, or the name behind `as` in the set-up",
        )),
        name => Ok(name.to_owned()),
    }
}

fn frames(words: &mut Words<'_>) -> Result<Frames, Problem> {
    const FRAMES: &str = "write a frame (701#00, 581#43*), or nmt start 5, sync, boot-up, emcy \
                          8130h, abort 06020000h, read 1017h or write 1017h";
    let start = *words;
    let what = match words.next() {
        "nmt" => {
            let command = command(words)?;
            let node = match words.is_empty() {
                true => None,
                false if words.take("all") => Some(0),
                false => Some(words.number(0, 127)? as u8),
            };
            Frames::Nmt(command, node)
        }
        "sync" => match Pattern::parse("080#*") {
            Ok(pattern) => Frames::Pattern(pattern),
            Err(error) => return Err(start.frame_problem(&error)),
        },
        "boot-up" => Frames::BootUp,
        "emcy" if words.is_empty() => Frames::Emcy(None),
        "emcy" => Frames::Emcy(Some(words.number(0, 0xFFFF)? as u16)),
        "abort" if words.is_empty() => Frames::Abort(None),
        "abort" => Frames::Abort(Some(abort(words)?)),
        kind @ ("read" | "write") => {
            let here = *words;
            let Some(address) = values::address(words.next()) else {
                return Err(here.problem("an object is missing", "write it like 1017h or 1018h:01"));
            };
            match kind {
                "read" => Frames::Read(address),
                _ => Frames::Written(address),
            }
        }
        "" => return Err(start.problem("a frame is missing", FRAMES)),
        word if !word.contains('#') => {
            return Err(start.problem(format!("`{word}` is no frame"), FRAMES));
        }
        _ => {
            *words = Words::new(0, "");
            match Pattern::parse(start.rest()) {
                Ok(pattern) => Frames::Pattern(pattern),
                Err(error) => return Err(start.frame_problem(&error)),
            }
        }
    };
    words.end()?;
    Ok(what)
}

fn fact(words: &mut Words<'_>) -> Result<Fact, Problem> {
    let start = *words;
    let mut head = words.split_at_word(&["of", "for"]);
    let (mut device, mut lasting) = (None, 0);
    while !words.is_empty() {
        if words.take("of") {
            device = Some(device_name(words)?);
        } else if words.take("for") {
            lasting = words.duration()?;
        } else {
            words.end()?;
        }
    }
    let kind = kind(&mut head)?;
    if matches!(kind, Kind::Quiet(_) | Kind::Undisturbed) && lasting == 0 {
        let help = "write `quiet 701#* for 2s`, `undisturbed for 2s`";
        return Err(start.problem("how long", help));
    }
    head.end()?;
    Ok(Fact {
        kind,
        device,
        lasting,
    })
}

fn kind(words: &mut Words<'_>) -> Result<Kind, Problem> {
    let start = *words;
    Ok(match words.next() {
        kind @ ("value" | "saved") => {
            let here = *words;
            let Some(address) = values::address(words.next()) else {
                let help = "write `value 1017h = 500`, with blanks around the `=`";
                return Err(here.problem("an object is missing", help));
            };
            match kind {
                "value" => Kind::Value(address, test(words)?),
                _ if words.is_empty() => Kind::Saved(address, None),
                _ => Kind::Saved(address, Some(test(words)?)),
            }
        }
        "state" => {
            let here = *words;
            let name = words.next();
            match STATES.into_iter().find(|state| *state == name) {
                Some(state) => Kind::State(state),
                None => {
                    let help = format!("there are {}", STATES.join(", "));
                    return Err(here.problem(format!("there is no state `{name}`"), help));
                }
            }
        }
        "led" => {
            let green = match words.next() {
                "green" => true,
                "red" => false,
                _ => return Err(start.problem("which LED", "write `led green flashing`")),
            };
            match Led::from_name(words.next()) {
                Some(led) => Kind::Led { green, led },
                None => return Err(start.problem("what it does", "there are off, flashing, on")),
            }
        }
        "node-id" => Kind::NodeId(number(words)?),
        "bitrate" => Kind::BitRate(number(words)?),
        "turned" => Kind::Turned(number(words)?),
        "rpm" => Kind::Rpm(number(words)?),
        "broken" => {
            let here = *words;
            let name = words.next();
            if !faults::NAMES.contains(&name) {
                let help = format!("there are {}", faults::NAMES.join(", "));
                return Err(here.problem(format!("there is no fault `{name}`"), help));
            }
            Kind::Broken(name.to_owned())
        }
        "undisturbed" => Kind::Undisturbed,
        "terminators" => Kind::Terminators(number(words)?),
        "quiet" => {
            let head = words.split_at_word(&[]);
            match Pattern::parse(head.rest()) {
                Ok(pattern) => Kind::Quiet(pattern),
                Err(error) => return Err(head.frame_problem(&error)),
            }
        }
        word => return Err(start.problem(format!("`{word}` is no condition"), HELP)),
    })
}

fn test(words: &mut Words<'_>) -> Result<Test, Problem> {
    let here = *words;
    let sign = words.next();
    let how = How::ALL.into_iter().find(|(name, _)| *name == sign);
    let value = words.split_at_word(&[]);
    let between = how.is_some_and(|(_, how)| how == How::Between);
    match how {
        Some((_, how)) if !value.is_empty() && between == value.rest().contains("..") => Ok(Test {
            how,
            text: value.rest().to_owned(),
        }),
        _ => Err(here.problem(
            "here stands how the value is compared",
            "write `= 500`, `!= 0`, `< 10`, `<= 10`, `> 10`, `>= 10` or `in 10..20`",
        )),
    }
}

/// A comparison with numbers.
fn number(words: &mut Words<'_>) -> Result<Test, Problem> {
    let here = *words;
    let test = test(words)?;
    let mut parts = test.text.split("..");
    if !parts.all(|part| super::facts::number(part).is_some()) {
        return Err(here.problem(format!("`{}` is no number", test.text), "write a number"));
    }
    Ok(test)
}
