//! Reads the lines of a checkpoint as conditions.

use std::format;
use std::prelude::v1::*;

use super::condition::{Alternative, Line, Seen, What, Who};
use crate::grammar::fact::{self, Fact};
use crate::grammar::frames::Frames;
use crate::grammar::pattern::Pattern;
use crate::grammar::problem::Problem;
use crate::grammar::tokens::Tokens;

/// Reads one line; `None` if it is empty or a comment. `before` is the line above it.
pub(super) fn line(
    number: u32,
    text: &str,
    before: Option<&Line>,
) -> Result<Option<Line>, Problem> {
    let mut tokens = Tokens::new(number, text);
    if tokens.is_empty() {
        return Ok(None);
    }
    let start = tokens;
    let then = tokens.take("then");
    let mut alternatives = Vec::new();
    let mut more = true;
    while more {
        let mut head = tokens.split_at_word(&["or", "--"]);
        alternatives.push(alternative(&mut head)?);
        more = tokens.take("or");
    }
    let say = tokens.take("--").then(|| tokens.rest().to_owned());
    if say.as_ref().is_some_and(String::is_empty) {
        return Err(tokens.problem(
            "the text after `--` is missing",
            "write a text for the learner",
        ));
    }
    let line = Line {
        line: number,
        then,
        alternatives,
        say,
    };
    let resets = |one: &Alternative| one.not && matches!(one.what, What::Seen(_));
    if line.alternatives.len() > 1 && line.alternatives.iter().any(resets) {
        let message = "`not` with a frame needs a line of its own";
        return Err(start.problem(message, "write two lines"));
    }
    if then && !(line.waits() && before.is_some_and(Line::waits)) {
        return Err(start.problem(
            "`then` needs a frame in this line and in the line above",
            "begin both lines with sent, came or seen",
        ));
    }
    let limited =
        |one: &Alternative| matches!(&one.what, What::Seen(seen) if seen.within.is_some());
    if !then && line.alternatives.iter().any(limited) {
        return Err(start.problem(
            "`within` needs a start",
            "begin the line with `then`; the time counts from the line above",
        ));
    }
    Ok(Some(line))
}

fn alternative(tokens: &mut Tokens<'_>) -> Result<Alternative, Problem> {
    let not = tokens.take("not");
    let here = *tokens;
    let who = match tokens.peek() {
        "sent" => Some(Who::Learner),
        "came" => Some(Who::Device),
        "seen" => Some(Who::Anybody),
        _ => None,
    };
    let (what, device, lasting) = match who {
        Some(who) => {
            tokens.next();
            let (seen, device) = seen(who, tokens)?;
            let plain = seen.times == 1 && seen.every.is_none() && seen.within.is_none();
            if not && !plain {
                let message = "`not` with a frame cannot have a number or a time";
                return Err(here.problem(message, "write `not came 581#80*`"));
            }
            (What::Seen(seen), device, 0)
        }
        None => state(tokens)?,
    };
    tokens.end()?;
    Ok(Alternative {
        not,
        what,
        device,
        lasting,
    })
}

fn seen(who: Who, tokens: &mut Tokens<'_>) -> Result<(Seen, Option<String>), Problem> {
    let mut head = tokens.split_at_word(&["times", "every", "within", "of"]);
    let (mut times, mut every, mut within, mut device) = (1, None, None, None);
    if tokens.take("times") {
        times = head.split_last().number(1, 100_000)? as u32;
    }
    let what = Frames::parse(&mut head)?;
    while !tokens.is_empty() {
        if tokens.take("every") {
            let low = tokens.duration()?;
            let high = if tokens.take("to") {
                tokens.duration()?
            } else {
                low
            };
            every = Some((low, high));
        } else if tokens.take("within") {
            within = Some(tokens.duration()?);
        } else if tokens.take("of") {
            device = Some(device_name(tokens)?);
        } else {
            // The rest is not empty, so this returns an error.
            tokens.end()?;
        }
    }
    if every.is_some() && times < 2 {
        return Err(tokens.problem(
            "`every` needs a number of frames",
            "write `came 701#* 3 times every 500ms`",
        ));
    }
    let seen = Seen {
        who,
        what,
        times,
        every,
        within,
    };
    Ok((seen, device))
}

fn device_name(tokens: &mut Tokens<'_>) -> Result<String, Problem> {
    match tokens.next() {
        "" => Err(tokens.problem(
            "the device is missing",
            "write its number, or the name after `as` in the set-up",
        )),
        name => Ok(name.to_owned()),
    }
}

/// Parses a state, its device, and its duration.
fn state(tokens: &mut Tokens<'_>) -> Result<(What, Option<String>, u64), Problem> {
    let start = *tokens;
    let mut head = tokens.split_at_word(&["of", "for"]);
    let (mut device, mut lasting) = (None, 0);
    while !tokens.is_empty() {
        if tokens.take("of") {
            device = Some(device_name(tokens)?);
        } else if tokens.take("for") {
            lasting = tokens.duration()?;
        } else {
            tokens.end()?;
        }
    }
    let what = if head.take("disturbed") {
        let mut times = 1;
        if !head.is_empty() {
            times = head.number(1, 100_000)? as u32;
            if !head.take("times") {
                return Err(head.problem("`times` is missing", "write `disturbed 16 times`"));
            }
        }
        head.end()?;
        return Ok((What::Disturbed(times), device, lasting));
    } else if head.take("undisturbed") {
        What::Undisturbed
    } else if head.take("quiet") {
        let head = head.take_rest();
        What::Quiet(Pattern::parse(head.rest()).map_err(|error| head.frame_problem(&error))?)
    } else if let Some(fact) = Fact::parse(&mut head)? {
        head.end()?;
        return Ok((What::Fact(fact), device, lasting));
    } else {
        return Err(start.problem(
            format!("`{}` is not a condition", start.peek()),
            format!(
                "begin the line with sent, came, seen, quiet, undisturbed, disturbed, {}",
                fact::NAMES
            ),
        ));
    };
    if lasting == 0 {
        let help = "write `quiet 701#* for 2s` or `undisturbed for 2s`";
        return Err(start.problem("the duration is missing", help));
    }
    Ok((what, device, lasting))
}
