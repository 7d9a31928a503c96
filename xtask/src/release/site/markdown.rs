//! The parts of Markdown that the site needs: code, links, headings.

/// A part of a text, and whether it is code: a block between fences, or words between backticks.
fn stretches(text: &str) -> Vec<(&str, bool)> {
    let mut found = Vec::new();
    let (mut begin, mut at) = (0, 0);
    while at < text.len() {
        let rest = &text[at..];
        let is_line = at == 0 || text[..at].ends_with('\n');
        let end = if let Some(fence) = fence(rest).filter(|_| is_line) {
            block(rest, fence)
        } else if rest.starts_with('`') {
            words(rest)
        } else {
            let next = |sign: char| sign.len_utf8();
            at += rest.chars().next().map_or(1, next);
            continue;
        };
        found.push((&text[begin..at], false));
        found.push((&text[at..at + end], true));
        at += end;
        begin = at;
    }
    found.push((&text[begin..], false));
    found
}

/// The fence that a line begins with.
pub(super) fn fence(line: &str) -> Option<&str> {
    let line = line.trim_start_matches(' ');
    let sign = line.chars().next().filter(|sign| "`~".contains(*sign))?;
    let length = line.len() - line.trim_start_matches(sign).len();
    (length >= 3).then(|| &line[..length])
}

/// The length of a block of code, with its fences.
fn block(text: &str, fence: &str) -> usize {
    let mut length = 0;
    for (number, line) in text.split_inclusive('\n').enumerate() {
        length += line.len();
        let is_end =
            line.trim().starts_with(fence) && line.trim().chars().all(|c| fence.contains(c));
        if number > 0 && is_end {
            break;
        }
    }
    length
}

/// Length of the words between backticks; only that of the backticks if they are not closed.
fn words(text: &str) -> usize {
    let ticks = text.len() - text.trim_start_matches('`').len();
    let paragraph = text.find("\n\n").map_or(text, |end| &text[..end]);
    let mut at = ticks;
    while let Some(found) = paragraph[at..].find('`') {
        let run = &paragraph[at + found..];
        let length = run.len() - run.trim_start_matches('`').len();
        at += found + length;
        if length == ticks {
            return at;
        }
    }
    ticks
}

/// Replaces links: `place` gets each address and returns the new one, or `None` to keep only the
/// words of the link.
pub(super) fn with_links<E>(
    text: &str,
    mut place: impl FnMut(&str) -> Result<Option<String>, E>,
) -> Result<String, E> {
    let mut out = String::with_capacity(text.len());
    for (stretch, is_code) in stretches(text) {
        let mut rest = stretch;
        while let Some(start) = rest.find("](").filter(|_| !is_code) {
            let Some(length) = rest[start + 2..].find(')') else {
                break;
            };
            let (before, address) = (&rest[..start], &rest[start + 2..start + 2 + length]);
            rest = &rest[start + 3 + length..];
            out.push_str(before);
            match (place(address)?, out.rfind('[')) {
                (Some(address), _) => out.push_str(&format!("]({address})")),
                (None, Some(bracket)) => {
                    out.remove(bracket);
                }
                (None, None) => {}
            }
        }
        out.push_str(rest);
    }
    Ok(out)
}

/// Returns the anchor of a heading: `#speed-and-size`.
pub(super) fn anchor(title: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let lower = title.to_lowercase();
    lower
        .trim()
        .chars()
        .filter(kept)
        .collect::<String>()
        .replace(' ', "-")
}

#[cfg(test)]
mod tests {
    use super::{anchor, with_links};

    fn shouted(text: &str) -> String {
        let place = |address: &str| -> Result<Option<String>, ()> {
            Ok((address != "gone").then(|| address.to_uppercase()))
        };
        with_links(text, place).expect("every address has a place")
    }

    #[test]
    fn links_are_found_outside_code() {
        assert_eq!(
            shouted("see [a b](c/d.md#e), ![x](y.png)."),
            "see [a b](C/D.MD#E), ![x](Y.PNG)."
        );
        assert_eq!(
            shouted("[over\na line](x) and [`code`](z)"),
            "[over\na line](X) and [`code`](Z)"
        );
        let code = "`[a](b)` ``[a`](b)``\n```text\n[a](b)\n```\n~~~~\n[a](b)\n~~~\n[a](b)\n~~~~\n";
        assert_eq!(shouted(code), code);
        assert_eq!(shouted("a ` only, [b](c)"), "a ` only, [b](C)");
        assert_eq!(
            shouted("a ` here\n\n[b](c) ` there"),
            "a ` here\n\n[b](C) ` there"
        );
        assert_eq!(shouted("ä`ö`[ü](ß) [open](x"), "ä`ö`[ü](SS) [open](x");
    }

    #[test]
    fn a_link_without_a_place_leaves_its_words() {
        assert_eq!(shouted("in [`a/b`](gone), [c](d)"), "in `a/b`, [c](D)");
    }

    #[test]
    fn anchors_are_those_that_pages_have() {
        assert_eq!(anchor("How fast"), "how-fast");
        assert_eq!(anchor("… check an EDS"), "-check-an-eds");
        assert_eq!(
            anchor("01: Text and INI structure"),
            "01-text-and-ini-structure"
        );
    }
}
