//! The form of lines and texts in messages.

use std::format;
use std::prelude::v1::*;

/// Longest part of a line in a message, in characters.
const SHOWN: usize = 60;
/// Longest message, in characters.
const MESSAGE: usize = 400;

/// The first `limit` characters of a text, with `…` if it is longer.
fn cut(text: &str, limit: usize) -> String {
    match text.char_indices().nth(limit) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

/// A line in the form for messages.
pub(crate) fn line(text: &str) -> String {
    cut(text, SHOWN)
}

/// A message whose quotes are cut to the limit of a line.
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

/// `a, b or c`.
pub(crate) fn either<'t>(words: impl IntoIterator<Item = &'t str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    match words.as_slice() {
        [rest @ .., last] if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}
