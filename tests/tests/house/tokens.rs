//! Rust text as tokens: no comments, no literals, and no code that only a test run compiles.

/// One token; operators are single characters, except `::`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Token<'t> {
    /// Identifier, keyword or number.
    Word(&'t str),
    /// `::`
    Path,
    /// Any other character.
    Mark(char),
}

/// The tokens of a text without the parts behind `#[cfg(test)]`, and the line of each.
pub(crate) fn tokens(text: &str) -> (Vec<Token<'_>>, Vec<usize>) {
    let mut found = Vec::new();
    let mut lines = Vec::new();
    let mut line = 1;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if first.is_alphanumeric() || first == '_' {
            match raw_string(rest) {
                Some(length) => length,
                None => {
                    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
                    let word = &rest[..end.unwrap_or(rest.len())];
                    found.push(Token::Word(word));
                    word.len()
                }
            }
        } else if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            comment(rest)
        } else if first == '"' {
            string(rest)
        } else if first == '\'' {
            character(rest)
        } else if rest.starts_with("::") {
            found.push(Token::Path);
            2
        } else {
            if !first.is_whitespace() {
                found.push(Token::Mark(first));
            }
            first.len_utf8()
        };
        lines.resize(found.len(), line);
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    without_tests(&found, &lines)
}

/// Length of a raw string that begins here, as `r"…"`, `r#"…"#` or `br"…"`.
fn raw_string(text: &str) -> Option<usize> {
    let start = text.strip_prefix('b').unwrap_or(text).strip_prefix('r')?;
    let hashes = start.bytes().take_while(|byte| *byte == b'#').count();
    let inside = start[hashes..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    let length = inside.find(&end).map_or(inside.len(), |at| at + end.len());
    Some(text.len() - inside.len() + length)
}

/// Length of a block comment; they nest.
fn comment(text: &str) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < text.len() {
        match &text.as_bytes()[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at.min(text.len())
}

fn string(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut at = 1;
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(bytes.len())
}

/// Length of a character, or of the mark of a lifetime.
fn character(text: &str) -> usize {
    let inside = &text[1..];
    if inside.starts_with('\\') {
        // The character behind the backslash may be a quote itself.
        let end = inside.char_indices().skip(2).find(|(_, c)| *c == '\'');
        return end.map_or(text.len(), |(at, _)| at + 2);
    }
    let first = inside.chars().next().map_or(0, char::len_utf8);
    if inside[first..].starts_with('\'') {
        first + 2
    } else {
        1
    }
}

/// Removes each item after `#[cfg(test)]`.
fn without_tests<'t>(all: &[Token<'t>], lines: &[usize]) -> (Vec<Token<'t>>, Vec<usize>) {
    use Token::{Mark, Word};
    const TEST: [Token<'_>; 7] = [
        Mark('#'),
        Mark('['),
        Word("cfg"),
        Mark('('),
        Word("test"),
        Mark(')'),
        Mark(']'),
    ];
    let mut kept = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < all.len() {
        if !all[at..].starts_with(&TEST) {
            kept.0.push(all[at]);
            kept.1.push(lines[at]);
            at += 1;
            continue;
        }
        let mut depth = 0;
        for token in &all[at..] {
            at += 1;
            match token {
                Mark('{') => depth += 1,
                Mark('}') => depth -= 1,
                _ => {}
            }
            if depth == 0 && matches!(token, Mark('}' | ';')) {
                break;
            }
        }
    }
    kept
}

#[test]
fn comments_literals_and_tests_are_left_out() {
    let text = "a::b /* c /* d */ */ // e\n'x' '\\'' 'y \"g\\\"h\" r#\"i\"j\"# br\"k\" l\n\
                #[cfg(test)]\nmod tests { m {} }\n#[cfg(test)] mod n; o";
    let (tokens, lines) = tokens(text);
    let words: Vec<_> = tokens
        .into_iter()
        .zip(lines)
        .filter_map(|(token, line)| match token {
            Token::Word(word) => Some((word, line)),
            _ => None,
        })
        .collect();
    assert_eq!(words, [("a", 1), ("b", 1), ("y", 2), ("l", 2), ("o", 5)]);
}
