//! What a checkpoint wants: lines of a `check` block.

use std::format;
use std::prelude::v1::*;

use crate::sim::script::Pattern;
use crate::sim::{Led, faults};

/// A mistake and its remedy.
type Wrong = (String, String);

/// How a number is compared.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Comparison {
    Equal,
    Other,
    AtLeast,
    AtMost,
}

/// What a line looks at.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Subject {
    /// A frame since the step began: from a device, or from outside.
    Frame {
        pattern: Pattern,
        from_device: bool,
        times: u32,
        /// Microseconds between two of them, to a tenth.
        every: Option<u64>,
    },
    /// An SDO abort with this code since the step began.
    Abort(u32),
    /// An emergency with this code since the step began.
    Emergency(u16),
    /// No frame of a device like this for so many microseconds.
    Quiet(Pattern, u64),
    /// Nothing was disturbed on the wire for so many microseconds.
    Undisturbed(u64),
    State(String),
    Value {
        object: String,
        comparison: Comparison,
        value: String,
    },
    /// The value would survive a power cycle.
    Saved(String),
    Led {
        green: bool,
        led: Led,
    },
    NodeId(u8),
    BitRate(u16),
    /// The shaft turned by at least so many revolutions since the step began.
    Turned(f64),
    Fault {
        name: String,
        broken: bool,
    },
    Terminators(u8),
}

/// One line of a `check` block.
#[derive(Clone, PartialEq, Debug)]
pub struct Check {
    /// As it was written.
    pub text: String,
    /// What it says to a person, where the author said it: `… -- the node is silent`.
    pub words: Option<String>,
    /// Which device it is about, from 0.
    pub(super) device: usize,
    pub(super) subject: Subject,
}

const HELP: &str = "a check begins with seen, sent, abort, emcy, quiet, undisturbed, state, value, \
                    saved, led, nodeid, bitrate, turned, fault or terminators";

impl Check {
    /// Reads a line; `None` for an empty one or a comment.
    pub(super) fn parse(line: &str) -> Result<Option<Self>, Wrong> {
        let (line, words) = match line.split_once(" -- ") {
            Some((line, words)) => (line.trim(), Some(words.trim().to_owned())),
            None => (line.trim(), None),
        };
        if line.is_empty() || line.starts_with("# ") {
            return Ok(None);
        }
        let mut rest = line;
        let mut device = 0;
        if let Some(after) = rest.strip_prefix("device ") {
            let (number, after) = split(after);
            device = match number.parse::<usize>() {
                Ok(number) if number > 0 => number - 1,
                _ => return wrong(format!("`{number}` is no device"), "devices count from 1"),
            };
            rest = after;
        }
        Ok(Some(Self {
            text: line.to_owned(),
            words,
            device,
            subject: subject(rest)?,
        }))
    }
}

fn wrong<T>(message: impl Into<String>, help: impl Into<String>) -> Result<T, Wrong> {
    Err((message.into(), help.into()))
}

/// The first word and what follows it.
fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    match text.split_once(char::is_whitespace) {
        Some((word, rest)) => (word, rest.trim()),
        None => (text, ""),
    }
}

fn subject(text: &str) -> Result<Subject, Wrong> {
    let (word, rest) = split(text);
    Ok(match word {
        "seen" | "sent" => frame(rest, word == "seen")?,
        "abort" => Subject::Abort(number(rest)? as u32),
        "emcy" => Subject::Emergency(number(rest)? as u16),
        "quiet" => {
            let (head, time) = rest.rsplit_once(' ').unwrap_or((rest, ""));
            Subject::Quiet(pattern(head)?, duration(time)?)
        }
        "undisturbed" => Subject::Undisturbed(duration(rest)?),
        "state" => match rest {
            "off" | "initialising" | "pre-operational" | "operational" | "stopped" => {
                Subject::State(rest.into())
            }
            _ => {
                return wrong(
                    format!("there is no state `{rest}`"),
                    "there are off, initialising, pre-operational, operational and stopped",
                );
            }
        },
        "value" => value(rest)?,
        "saved" => Subject::Saved(rest.into()),
        "led" => {
            let (colour, what) = split(rest);
            match (colour, Led::from_name(what)) {
                ("green" | "red", Some(led)) => Subject::Led {
                    green: colour == "green",
                    led,
                },
                _ => return wrong(format!("`{rest}` is no lamp"), "write `led green flashing`"),
            }
        }
        "nodeid" => Subject::NodeId(number(rest)? as u8),
        "bitrate" => Subject::BitRate(number(rest)? as u16),
        "turned" => match rest.parse() {
            Ok(turns) => Subject::Turned(turns),
            Err(_) => {
                return wrong(
                    format!("`{rest}` is no number of turns"),
                    "write `turned 1`",
                );
            }
        },
        "fault" => {
            let (name, how) = split(rest);
            if !faults::NAMES.contains(&name) || !matches!(how, "on" | "off") {
                return wrong(
                    format!("`{rest}` is no fault"),
                    "write `fault battery-low on`",
                );
            }
            Subject::Fault {
                name: name.into(),
                broken: how == "on",
            }
        }
        "terminators" => Subject::Terminators(number(rest)? as u8),
        _ => return wrong(format!("`{word}` begins no check"), HELP),
    })
}

/// `701#05 every 500ms 3 times`.
fn frame(text: &str, from_device: bool) -> Result<Subject, Wrong> {
    let mut head = text.trim();
    let (mut times, mut every) = (1, None);
    if let Some(before) = head.strip_suffix(" times") {
        let (before, count) = before.rsplit_once(' ').unwrap_or(("", before));
        times = number(count)?.clamp(1, 1_000_000) as u32;
        head = before.trim();
    }
    if let Some((before, time)) = head.rsplit_once(" every ") {
        every = Some(duration(time)?);
        times = times.max(2);
        head = before.trim();
    }
    Ok(Subject::Frame {
        pattern: pattern(head)?,
        from_device,
        times,
        every,
    })
}

fn pattern(text: &str) -> Result<Pattern, Wrong> {
    Pattern::parse(text).map_err(|error| (error.message.clone(), error.help.into()))
}

/// `6004h = 0`, `"Position value" >= 100`.
fn value(text: &str) -> Result<Subject, Wrong> {
    let signs = [
        (">=", Comparison::AtLeast),
        ("<=", Comparison::AtMost),
        ("!=", Comparison::Other),
        ("=", Comparison::Equal),
    ];
    for (sign, comparison) in signs {
        if let Some((object, value)) = text.split_once(sign) {
            return Ok(Subject::Value {
                object: object.trim().into(),
                comparison,
                value: value.trim().into(),
            });
        }
    }
    wrong(
        "a comparison is missing",
        "write `value 6001h = 4096`, or with >=, <=, !=",
    )
}

/// Decimal, `0x…` or `…h`.
fn number(text: &str) -> Result<u64, Wrong> {
    let text = text.trim();
    let hex = text
        .strip_prefix("0x")
        .or_else(|| text.strip_suffix('h').or_else(|| text.strip_suffix('H')));
    let parsed = match hex {
        Some(digits) => u64::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| {
        (
            format!("`{text}` is no number"),
            "write 5, 0x1F or 1Fh".into(),
        )
    })
}

/// `500ms`, `2s`.
fn duration(text: &str) -> Result<u64, Wrong> {
    let text = text.trim();
    for (unit, micros) in [("us", 1.0), ("ms", 1e3), ("min", 60e6), ("s", 1e6)] {
        let number = text
            .strip_suffix(unit)
            .and_then(|rest| rest.parse::<f64>().ok());
        if let Some(number) = number.filter(|number| (0.0..1e9).contains(number)) {
            return Ok((number * micros) as u64);
        }
    }
    wrong(format!("`{text}` is no time"), "write 500ms or 2s")
}
