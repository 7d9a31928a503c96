//! A complete line: its time, then a verb or a frame.

use std::format;
use std::prelude::v1::*;

use od_runtime::Instant;
use od_runtime::encoder::Fault;

use super::action::{Action, Choice, Draw, When};
use super::deed::Deed;
use super::draw::drawn;
use super::duration::is_decimal;
use super::named_frame::NamedFrame;
use super::problem::Problem;
use super::shown::either;
use super::tokens::Tokens;
use super::verbs::VERBS;
use crate::logs::candump;

/// Time stamps from here on are times of day since 1970; the first one is then the origin.
const WALL_CLOCK: u64 = 100_000_000_000_000;

/// Words that begin a line and are not verbs.
const OTHERS: [&str; 4] = ["wait", "at", "after", "random"];
/// Highest number of draws of a line.
const DRAWS: u64 = 10_000;
const RANDOM: &str = "write `random shaft rpm -3000..3000`, `random fault`, `random power cut` or \
                      `random 10 times fault | wait 1ms..2s`";

/// Reads a line that is not empty. `origin` is the first time stamp of a log.
pub(crate) fn line(
    mut tokens: Tokens<'_>,
    origin: &mut Option<u64>,
) -> Result<(When, Action), Problem> {
    if tokens.take("wait") {
        let micros = tokens.duration()?;
        tokens.end()?;
        return Ok((When::After(micros), Action::Deed(Deed::Wait)));
    }
    if tokens.take("random") {
        return Ok((When::Next, Action::Random(draw(tokens, *origin)?)));
    }
    let when = time(&mut tokens, origin)?;
    if tokens.is_empty() && when != When::Next {
        return Ok((when, Action::Deed(Deed::Wait)));
    }
    let start = tokens;
    let word = tokens.next();
    let action = match VERBS.iter().find(|verb| verb.name == word) {
        Some(verb) => (verb.parse)(&mut tokens).map_err(|mut problem| {
            if problem.help.is_empty() {
                problem.help = format!("write {}", verb.usage);
            }
            problem
        })?,
        None if word == "random" => {
            let help = "write the time after it, such as `random after 100ms power off`";
            return Err(start.problem("`random` begins the line", help));
        }
        None if word == "wait" => {
            return Err(start.problem("a line can have only one time", "remove one of the two"));
        }
        None => {
            tokens = start;
            frame(&mut tokens, word)?
        }
    };
    tokens.end()?;
    Ok((when, action))
}

/// Reads `3 times fault | power cut`: the lines of a draw.
fn draw(mut tokens: Tokens<'_>, origin: Option<u64>) -> Result<Draw, Problem> {
    let mut ahead = tokens;
    ahead.next();
    let mut times = 1;
    if ahead.peek() == "times" {
        times = tokens.number(1, DRAWS)? as u32;
        tokens.next();
    }
    let mut choices = Vec::new();
    loop {
        let split = tokens.split_at_sign(&[("|", ())]);
        let (line, is_last) = match split {
            Some((line, ())) => (line, false),
            None => (tokens.take_rest(), true),
        };
        choices.push(choice(line, origin)?);
        if is_last {
            return Ok(Draw { times, choices });
        }
    }
}

/// A line that can be drawn: it must be valid with both ends of its ranges.
fn choice(here: Tokens<'_>, origin: Option<u64>) -> Result<Choice, Problem> {
    if here.is_empty() {
        return Err(here.problem("the line to draw is missing", RANDOM));
    }
    if here.peek() == "random" {
        return Err(here.problem("a draw inside a draw", "remove this `random`"));
    }
    let faults = Fault::NAMES.map(|(_, name)| (name, false));
    let end = |is_high: bool| {
        let text = drawn(here.rest(), &faults, &mut |last| {
            if is_high { last } else { 0 }
        });
        let text = text.map_err(|why| here.problem(why, RANDOM))?;
        let mut origin = origin;
        let read = line(Tokens::new(0, &text), &mut origin);
        read.map_err(|problem| here.problem(problem.message, problem.help))
    };
    end(false)?;
    let most = end(true)?;
    match most.1 {
        Action::Deed(_) | Action::Read { .. } | Action::Write { .. } => Ok(Choice {
            text: here.rest().to_owned(),
            most,
        }),
        _ => Err(here.problem("`random` draws only what happens on the bench", RANDOM)),
    }
}

/// Reads `(0.100000)`, `at 1.5s`, `after 100ms`, or nothing.
fn time(tokens: &mut Tokens<'_>, origin: &mut Option<u64>) -> Result<When, Problem> {
    let at = |micros| When::At(Instant::from_micros(micros));
    if tokens.take("at") {
        return tokens.duration().map(at);
    }
    if tokens.take("after") {
        return tokens.duration().map(When::After);
    }
    if !tokens.peek().starts_with('(') {
        return Ok(When::Next);
    }
    let here = *tokens;
    let micros = match tokens.stamp() {
        Some(micros) => micros,
        None => no_stamp(here)?,
    };
    let first = *origin.get_or_insert(if micros >= WALL_CLOCK { micros } else { 0 });
    here.limited(Some(micros.saturating_sub(first))).map(at)
}

/// Text in parentheses that is not a time stamp.
fn no_stamp(here: Tokens<'_>) -> Result<u64, Problem> {
    let word = here.peek();
    let inner = word
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'));
    if inner.is_some_and(is_decimal) {
        return here.limited(None);
    }
    let message = format!("`{word}` is not a time stamp");
    Err(here.problem(message, "write seconds in parentheses, such as (0.100000)"))
}

/// Reads a line of a log, or a frame in the form of `cansend` with optional blanks between its bytes.
fn frame(tokens: &mut Tokens<'_>, word: &str) -> Result<Action, Problem> {
    let here = tokens.take_rest();
    let mut words = here.rest().split_whitespace();
    let second = words.nth(1).unwrap_or("");
    let frame = if word.contains('#') {
        candump::parse_frame(here.rest())
    } else if second.contains('#') || here.rest().contains('[') {
        candump::parse_line(here.rest()).map(|line| line.frame)
    } else {
        let names = VERBS.iter().map(|verb| verb.name);
        let help = format!(
            "begin the line with a frame (601#4004600000000000), or with {}",
            either(names.chain(OTHERS))
        );
        return Err(here.problem(format!("`{word}` is not a verb or a frame"), help));
    };
    let frame = frame.map_err(|error| here.frame_problem(&error))?;
    Ok(Action::Deed(Deed::Send {
        frame: NamedFrame::Frame(frame),
        times: 1,
        every: 0,
    }))
}
