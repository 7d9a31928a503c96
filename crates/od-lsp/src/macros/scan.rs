//! A tokenizer for Rust sources, as precise as calls of a macro need; it never fails.

use std::ops::Range;

/// Kind of a token.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    Word,
    /// A number with its suffix: `0x1018sub2`.
    Number,
    /// `"…"`; its range excludes the quotes.
    Text,
    /// `b"…"`
    Bytes,
    Sign(u8),
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Token {
    pub(crate) kind: Kind,
    pub(crate) bytes: Range<usize>,
}

/// The tokens of a source; comments and characters are left out.
pub(crate) fn tokens(source: &str) -> Vec<Token> {
    let bytes = source.as_bytes();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let rest = &bytes[at..];
        let is_word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_' || *b >= 0x80;
        let length = |rest: &[u8]| rest.iter().take_while(|b| is_word(b)).count();
        let (kind, len) = match byte {
            b'/' if rest.starts_with(b"//") => (None, line(rest)),
            b'/' if rest.starts_with(b"/*") => (None, comment(rest)),
            b'"' => {
                let end = text(&rest[1..]);
                tokens.push(Token {
                    kind: Kind::Text,
                    bytes: at + 1..at + 1 + end,
                });
                (None, end + 2)
            }
            b'r' if raw(rest).is_some() => (None, raw(rest).unwrap_or(1)),
            b'b' if rest.starts_with(b"b\"") => (Some(Kind::Bytes), text(&rest[2..]) + 3),
            b'\'' => (None, character(rest)),
            b'0'..=b'9' => (Some(Kind::Number), length(rest)),
            b if is_word(&b) => (Some(Kind::Word), length(rest)),
            b if b.is_ascii_whitespace() => (None, 1),
            b => (Some(Kind::Sign(b)), 1),
        };
        let end = (at + len).min(bytes.len());
        if let Some(kind) = kind {
            tokens.push(Token {
                kind,
                bytes: at..end,
            });
        }
        at = end;
    }
    tokens
}

fn line(rest: &[u8]) -> usize {
    rest.iter().take_while(|b| **b != b'\n').count()
}

/// A comment, which may contain others.
fn comment(rest: &[u8]) -> usize {
    let mut depth = 0usize;
    let mut at = 0;
    while at < rest.len() {
        if rest[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if rest[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    rest.len()
}

/// Length of a text up to its quote.
fn text(rest: &[u8]) -> usize {
    let mut at = 0;
    while let Some(byte) = rest.get(at) {
        match byte {
            b'"' => return at,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    rest.len()
}

/// Length of `r"…"` and `r#"…"#`; `None` for a word.
fn raw(rest: &[u8]) -> Option<usize> {
    let signs = rest[1..].iter().take_while(|b| **b == b'#').count();
    if rest.get(1 + signs) != Some(&b'"') {
        return None;
    }
    let start = signs + 2;
    let end = [b"\"", &b"#".repeat(signs)[..]].concat();
    let found = rest[start..]
        .windows(end.len())
        .position(|part| part == end);
    Some(found.map_or(rest.len(), |found| start + found + end.len()))
}

/// Length of `'a'` and `'\n'`; for a lifetime, of its quote.
fn character(rest: &[u8]) -> usize {
    if rest.get(1) == Some(&b'\\') {
        let end = rest[2..].iter().skip(1).take(10).position(|b| *b == b'\'');
        return end.map_or(1, |end| end + 4);
    }
    let text = std::str::from_utf8(&rest[1..rest.len().min(6)]);
    let valid = match text {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&rest[1..1 + error.valid_up_to()]).unwrap_or_default(),
    };
    let len = valid.chars().next().map_or(0, char::len_utf8);
    match rest.get(1 + len) {
        Some(b'\'') if len > 0 => len + 2,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_characters_are_left_out() {
        let source = "a // b \"\n/* /* c */ \" */ 'x' '\\'' '\\u{41}' 'life \"t\\\"x\" r#\"q\"\"# b\"y\" 0x1018sub2 = é; '";
        let found: Vec<_> = tokens(source)
            .into_iter()
            .map(|token| (token.kind, &source[token.bytes]))
            .collect();
        let expected = [
            (Kind::Word, "a"),
            (Kind::Word, "life"),
            (Kind::Text, "t\\\"x"),
            (Kind::Bytes, "b\"y\""),
            (Kind::Number, "0x1018sub2"),
            (Kind::Sign(b'='), "="),
            (Kind::Word, "é"),
            (Kind::Sign(b';'), ";"),
        ];
        assert_eq!(found, expected);
        for broken in ["\"", "/*", "'", "'\\", "r#\"", "b\"", "/*/", "'é", "\"\\"] {
            tokens(broken);
        }
    }
}
