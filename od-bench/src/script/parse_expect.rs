//! `expect` and `sdo` lines, and what says how often and when.

use std::format;
use std::prelude::v1::*;

use od_runtime::AbortCode;

use super::statement::{Action, Expect, Outcome, Timing};
use super::words::Words;
use super::{Pattern, Problem};
use crate::leds::Led;

/// A frame, then `N times`, `within D`, `after D`, `every D`.
pub(super) fn repeated<'t>(words: &mut Words<'t>) -> Result<(Words<'t>, u32, Timing), Problem> {
    let mut head = words.split_at_word(&["times", "within", "after", "every"]);
    let mut times = 1;
    if words.take("times") {
        times = head.split_last().number(1, 1_000_000)? as u32;
    }
    let timing = timing(words)?;
    if times == 1 && words.at_number() {
        times = words.number(1, 1_000_000)? as u32;
        if !words.take("times") {
            return Err(words.problem("`times` is missing", "write `5 times`"));
        }
    }
    Ok((head, times, timing))
}

fn timing(words: &mut Words<'_>) -> Result<Timing, Problem> {
    if words.take("within") {
        return words.duration().map(Timing::Within);
    }
    if words.take("after") {
        return words.duration().map(Timing::After);
    }
    if words.take("every") {
        return words.duration().map(Timing::Every);
    }
    Ok(Timing::Now)
}

/// `sdo read 6004h = 5`, `sdo write 6001h = 4096 as u32 aborts 06090031h`.
pub(super) fn sdo(words: &mut Words<'_>) -> Result<Action, Problem> {
    const HELP: &str = "write `sdo read 6004h`, `sdo read 6004h = 5`, `sdo write 6001h = 4096`, \
                        each with ` aborts 06090031h` at the end if it has to fail";
    let here = *words;
    let kind = words.next();
    let mut body = words.split_at_word(&["aborts"]);
    let aborts = if words.take("aborts") {
        Some(abort(words)?)
    } else {
        None
    };
    let object = match body.split_at_equals() {
        Some(head) => (head.rest().to_owned(), true),
        None => (body.rest().to_owned(), false),
    };
    if object.0.is_empty() {
        return Err(here.problem("an object is missing", HELP));
    }
    match (kind, object, aborts) {
        ("read", (object, false), None) => Ok(Action::Read {
            object,
            outcome: Outcome::Done,
        }),
        ("read", (object, false), Some(code)) => Ok(Action::Read {
            object,
            outcome: Outcome::Aborts(code),
        }),
        ("read", (object, true), None) if !body.is_empty() => Ok(Action::Read {
            object,
            outcome: Outcome::Value(body.rest().to_owned()),
        }),
        ("write", (object, true), aborts) => {
            let value = body.split_at_word(&["as"]);
            if value.is_empty() {
                return Err(body.problem("a value is missing", HELP));
            }
            let type_name = body.take("as").then(|| body.next().to_owned());
            body.end()?;
            let outcome = aborts.map_or(Outcome::Done, Outcome::Aborts);
            Ok(Action::Write {
                object,
                value: value.rest().to_owned(),
                type_name,
                outcome,
            })
        }
        _ => Err(here.problem("this is no SDO line", HELP)),
    }
}

/// An abort code that CiA 301 knows.
pub(crate) fn abort(words: &mut Words<'_>) -> Result<AbortCode, Problem> {
    let here = *words;
    let word = words.next();
    let digits = word
        .strip_suffix(['h', 'H'])
        .unwrap_or(word)
        .replace('_', "");
    let code = u32::from_str_radix(digits.trim_start_matches("0x"), 16).ok();
    code.and_then(AbortCode::from_code).ok_or_else(|| {
        here.problem(
            format!("`{word}` is no abort code"),
            "write eight hex digits, like 06090031h",
        )
    })
}

pub(super) fn expect(words: &mut Words<'_>) -> Result<Expect, Problem> {
    let start = *words;
    match words.next() {
        "silence" => words.duration().map(Expect::Silence),
        "state" => match words.next() {
            name @ ("operational" | "pre-operational" | "stopped" | "initialising" | "off") => {
                Ok(Expect::State(name.to_owned()))
            }
            word => Err(start.problem(
                format!("there is no state `{word}`"),
                "there are operational, pre-operational, stopped, initialising, off",
            )),
        },
        "value" => {
            let object = words.split_at_equals();
            let value = words.split_at_word(&[]);
            match object {
                Some(object) if !object.is_empty() && !value.is_empty() => Ok(Expect::Value {
                    object: object.rest().to_owned(),
                    value: value.rest().to_owned(),
                }),
                _ => Err(start.problem("a value line has a `=`", "write `expect value 6004h = 5`")),
            }
        }
        "led" => {
            let green = match words.next() {
                "green" => true,
                "red" => false,
                _ => return Err(start.problem("which LED", "write `expect led green flashing`")),
            };
            match Led::from_name(words.next()) {
                Some(led) => Ok(Expect::Led { green, led }),
                None => Err(start.problem("what LED does", "there are off, flashing, on")),
            }
        }
        "bitrate" => {
            let kbit = words.number(1, 1000)?;
            Ok(Expect::BitRate(kbit as u16))
        }
        "abort" => {
            let code = abort(words)?;
            Ok(Expect::Abort {
                code,
                timing: timing(words)?,
            })
        }
        _ => {
            *words = start;
            let (head, times, timing) = repeated(words)?;
            match Pattern::parse(head.rest()) {
                Ok(pattern) => Ok(Expect::Frame {
                    pattern,
                    times,
                    timing,
                }),
                Err(error) => Err(head.frame_problem(&error)),
            }
        }
    }
}
