//! Splits the text of a filter into tokens.

use crate::error::Error;

/// A token, and its place in the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'t> {
    pub(super) text: &'t str,
    pub(super) at: usize,
}

/// Brackets, `!`, `|`, a `-` before a term, and words; quotes can contain blanks.
pub(super) fn tokens(text: &str) -> Result<Vec<Token<'_>>, Error> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..].find(|c: char| !c.is_whitespace()) {
        at += start;
        let rest = &text[at..];
        let len = length(rest).ok_or_else(|| mistake(at, "the quote is not closed"))?;
        let text = &rest[..len];
        found.push(Token { text, at });
        at += len;
    }
    Ok(found)
}

/// Length of the first token; `None` if a quote is not closed.
fn length(rest: &str) -> Option<usize> {
    let mut chars = rest.chars();
    match (chars.next(), chars.next()) {
        (Some('(' | ')' | '!' | '|'), _) => return Some(1),
        (Some('-'), Some(next)) if !next.is_whitespace() => return Some(1),
        _ => {}
    }
    // A word with a quote ends at the closing quote.
    let before = rest.find(|c: char| c.is_whitespace() || "()!|\"".contains(c));
    if let Some(quote) = before.filter(|at| rest[*at..].starts_with('"')) {
        let end = rest[quote + 1..].find('"')?;
        return Some(quote + end + 2);
    }
    comparison(rest).or_else(|| {
        let end = rest.find(|c: char| c.is_whitespace() || "()|".contains(c));
        Some(end.unwrap_or(rest.len()))
    })
}

/// Wireshark's spelling may have blanks around its operators: `canopen.cob_id == 181`.
fn comparison(rest: &str) -> Option<usize> {
    let is_name = |c: char| c.is_ascii_alphabetic() || c == '_' || c == '.';
    let name = rest.find(|c: char| !is_name(c))?;
    let after = rest[name..].trim_start();
    let value = after
        .strip_prefix("==")
        .or_else(|| after.strip_prefix("!="))?;
    let value = value.trim_start();
    let len = value.find(|c: char| c.is_whitespace() || "()|".contains(c));
    let len = len.unwrap_or(value.len());
    (rest[..name].contains('.') && len > 0).then(|| rest.len() - value.len() + len)
}

/// The error for a mistake at this place of a filter's text, in bytes from the start.
pub(super) fn mistake(at: usize, what: impl Into<String>) -> Error {
    let what = what.into();
    Error::Filter { at, what }
}
