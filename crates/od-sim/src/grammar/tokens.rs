//! The tokenizer: splits a line into words with their columns.

use std::format;
use std::prelude::v1::*;

use od_runtime::encoder::Fault;
use od_wire::nmt::Command;

use super::duration;
use super::problem::Problem;
use super::shown::{brief, either};
use crate::cursor::Cursor;
use crate::logs::stamp;

/// Longest moment or duration: 100 years of 365 days, in microseconds.
const LONGEST: u64 = 100 * 365 * 86_400 * 1_000_000;

const TOO_LONG: &str = "the limit is 100 years, 3153600000s";

/// The rest of a line, read from the front.
#[derive(Clone, Copy)]
pub(crate) struct Tokens<'t> {
    line: u32,
    rest: Cursor<'t>,
}

impl<'t> Tokens<'t> {
    /// The line without its comment and the blanks around it. A comment begins with `#` at
    /// the start of a line or after a blank; `601#40` is a frame.
    pub(crate) fn new(line: u32, text: &'t str) -> Self {
        let mut end = text.len();
        let mut quoted = false;
        let mut before = ' ';
        for (at, c) in text.char_indices() {
            if c == '"' {
                quoted = !quoted;
            }
            if c == '#' && before.is_whitespace() && !quoted {
                end = at;
                break;
            }
            before = c;
        }
        let rest = Cursor::new(text[..end].trim_end());
        Self { line, rest }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rest.text.is_empty()
    }

    /// The whole rest.
    pub(crate) fn rest(&self) -> &'t str {
        self.rest.text
    }

    pub(crate) fn peek(&self) -> &'t str {
        self.rest.peek()
    }

    /// The next word; empty at the end of the line.
    pub(crate) fn next(&mut self) -> &'t str {
        self.rest.next()
    }

    /// Takes a time stamp of a log, if the rest begins with one: microseconds.
    pub(crate) fn stamp(&mut self) -> Option<u64> {
        stamp::take(&mut self.rest)
    }

    /// Takes the next word if it equals this one.
    pub(crate) fn take(&mut self, word: &str) -> bool {
        let here = self.peek() == word;
        if here {
            self.next();
        }
        here
    }

    /// Splits off the part that begins with the first of these words.
    pub(crate) fn split_at_word(&mut self, keywords: &[&str]) -> Self {
        let mut head = *self;
        let mut quoted = false;
        loop {
            let word = self.peek();
            if word.is_empty() || (!quoted && keywords.contains(&word)) {
                break;
            }
            quoted ^= word.matches('"').count() % 2 == 1;
            self.next();
        }
        head.rest.text = head.rest.text[..head.rest.text.len() - self.rest.text.len()].trim_end();
        head
    }

    /// Splits off the last word.
    pub(crate) fn split_last(&mut self) -> Self {
        let at = self
            .rest
            .text
            .rfind(char::is_whitespace)
            .map_or(0, |at| at + 1);
        let mut last = *self;
        last.rest.column += self.rest.text[..at].chars().count();
        last.rest.text = &self.rest.text[at..];
        self.rest.text = self.rest.text[..at].trim_end();
        last
    }

    /// Splits at the first of these signs outside quotes and drops it. Returns the part before it, and
    /// the sign. A sign of letters is a word of its own.
    pub(crate) fn split_at_sign<T: Copy>(&mut self, signs: &[(&str, T)]) -> Option<(Self, T)> {
        let mut quoted = false;
        let mut before = ' ';
        for (at, c) in self.rest.text.char_indices() {
            quoted ^= c == '"';
            let rest = &self.rest.text[at..];
            let is_here = |sign: &str| {
                let word = sign.starts_with(|c: char| c.is_alphabetic());
                let is_word = || before.is_whitespace() && rest[sign.len()..].starts_with(' ');
                rest.starts_with(sign) && (!word || is_word())
            };
            // Of `<` and `<=` choose the longer one.
            let found = signs.iter().filter(|(sign, _)| !quoted && is_here(sign));
            if let Some((sign, meaning)) = found.max_by_key(|(sign, _)| sign.len()) {
                let mut head = *self;
                head.rest.text = self.rest.text[..at].trim_end();
                let end = at + sign.len();
                self.rest.skip(end);
                return Some((head, *meaning));
            }
            before = c;
        }
        None
    }

    /// Splits at the first `=` outside quotes.
    pub(crate) fn split_at_equals(&mut self) -> Option<Self> {
        self.split_at_sign(&[("=", ())]).map(|(head, ())| head)
    }

    /// Takes the whole rest.
    pub(crate) fn take_rest(&mut self) -> Self {
        self.split_at_word(&[])
    }

    pub(crate) fn problem(&self, message: impl Into<String>, help: impl Into<String>) -> Problem {
        Problem {
            line: self.line,
            column: self.rest.column,
            message: brief(&message.into()),
            help: help.into(),
        }
    }

    /// A mistake at the front; the table of verbs adds the syntax.
    pub(crate) fn wrong(&self, message: impl Into<String>) -> Problem {
        self.problem(message, "")
    }

    /// A mistake in a frame at the front.
    pub(crate) fn frame_problem(&self, error: &Problem) -> Problem {
        let mut problem = self.problem(error.message.clone(), error.help.clone());
        problem.column += error.column - 1;
        problem
    }

    /// Checks that nothing is left.
    pub(crate) fn end(&self) -> Result<(), Problem> {
        if self.is_empty() {
            return Ok(());
        }
        Err(self.problem(
            format!("unexpected `{}`", self.peek()),
            "remove it, or write it into a line of its own; a comment begins with `#`",
        ))
    }

    /// A word of a table, and its meaning.
    pub(crate) fn one_of<T: Copy>(
        &mut self,
        what: &str,
        table: &[(&str, T)],
    ) -> Result<T, Problem> {
        let here = *self;
        let word = self.next();
        if let Some((_, meaning)) = table.iter().find(|(name, _)| *name == word) {
            return Ok(*meaning);
        }
        let message = match word {
            "" => format!("{what} is missing"),
            _ => format!("{what} `{word}` does not exist"),
        };
        let names = either(table.iter().map(|(name, _)| *name));
        Err(here.problem(message, format!("write {names}")))
    }

    /// Returns whether a number begins here, even one that is too large.
    pub(crate) fn at_number(&self) -> bool {
        let word = self.peek();
        word.strip_prefix('-')
            .unwrap_or(word)
            .starts_with(|c: char| c.is_ascii_digit())
    }

    /// A moment or a duration in this line; `None` if it is too large to count.
    pub(crate) fn limited(&self, micros: Option<u64>) -> Result<u64, Problem> {
        self.within(self.peek(), micros)
    }

    /// Checks that the repetitions of a line do not take longer, either.
    pub(crate) fn limited_turns(&self, times: u32, every: u64) -> Result<(), Problem> {
        let micros = every.checked_mul(u64::from(times));
        self.within(&format!("{times} times"), micros).map(|_| ())
    }

    fn within(&self, shown: &str, micros: Option<u64>) -> Result<u64, Problem> {
        micros
            .filter(|micros| *micros <= LONGEST)
            .ok_or_else(|| self.problem(format!("`{shown}` is too long"), TOO_LONG))
    }

    /// A duration in microseconds: `500ms`, `1.5s`, `20us`, `2min`.
    pub(crate) fn duration(&mut self) -> Result<u64, Problem> {
        let here = *self;
        let word = self.next();
        if let Some(micros) = duration::parse(word) {
            return here.limited(Some(micros));
        }
        let message = match word {
            "" => String::from("a duration is missing"),
            _ => format!("`{word}` is not a duration"),
        };
        Err(here.problem(message, "write 500ms, 1.5s, 20us or 2min"))
    }

    /// A whole number in a range.
    pub(crate) fn number(&mut self, low: u64, high: u64) -> Result<u64, Problem> {
        let here = *self;
        let word = self.next();
        let value = od_model::values::integer(word).and_then(|value| u64::try_from(value).ok());
        value
            .filter(|value| (low..=high).contains(value))
            .ok_or_else(|| {
                let message = match word {
                    "" => String::from("a number is missing"),
                    _ => format!("`{word}` is not valid"),
                };
                here.problem(message, format!("write a number from {low} to {high}"))
            })
    }
}

/// Reads the name of a fault.
pub(super) fn fault_name(tokens: &mut Tokens<'_>) -> Result<&'static str, Problem> {
    tokens.one_of("fault", &Fault::NAMES.map(|(_, name)| (name, name)))
}

/// Reads an NMT command and its node: 0 for `all`, `None` if it is missing.
pub(crate) fn nmt_command(tokens: &mut Tokens<'_>) -> Result<(Command, Option<u8>), Problem> {
    let command = tokens.one_of(
        "NMT command",
        &[
            ("start", Command::Start),
            ("stop", Command::Stop),
            ("preop", Command::EnterPreOperational),
            ("reset", Command::ResetNode),
            ("reset-comm", Command::ResetCommunication),
        ],
    )?;
    let node = if tokens.is_empty() {
        None
    } else if tokens.take("all") {
        Some(0)
    } else {
        Some(tokens.number(0, 127)? as u8)
    };
    Ok((command, node))
}
