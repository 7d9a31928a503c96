//! Lines, messages and durations as messages show them.

use std::format;
use std::prelude::v1::*;

/// Characters of a line that are shown.
const SHOWN: usize = 60;
/// Characters of a message that are shown.
const MESSAGE: usize = 400;

/// The first `limit` characters of a text, and `…` if it is longer.
fn cut(text: &str, limit: usize) -> String {
    match text.char_indices().nth(limit) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

/// A line as messages show it.
pub(crate) fn line(text: &str) -> String {
    cut(text, SHOWN)
}

/// A message whose quotes are not longer than a line is shown.
pub(crate) fn brief(message: &str) -> String {
    if message.len() <= SHOWN {
        return message.to_owned();
    }
    let mut brief = String::new();
    for (number, piece) in message.split('`').enumerate() {
        if number > 0 {
            brief.push('`');
        }
        match number % 2 {
            1 => brief.push_str(&line(piece)),
            _ => brief.push_str(piece),
        }
    }
    cut(&brief, MESSAGE)
}

/// Microseconds as a script writes them.
pub(crate) fn duration(micros: u64) -> String {
    match (micros % 1_000_000, micros % 1000) {
        (0, _) if micros > 0 => format!("{}s", micros / 1_000_000),
        (_, 0) => format!("{}ms", micros / 1000),
        _ => format!("{micros}us"),
    }
}

/// `a, b or c`.
pub(crate) fn either<'t>(words: impl IntoIterator<Item = &'t str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    match words.as_slice() {
        [rest @ .., last] if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}
