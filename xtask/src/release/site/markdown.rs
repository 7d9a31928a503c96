//! Markdown as far as the site reads it: code, links, headings.

/// A stretch of text, and whether it is code: a block between fences, or words between backticks.
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

/// The signs of a fence that a line begins with.
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

/// The length of words between backticks; of only the backticks if nothing closes them.
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

/// The text with other links: `place` gets the address of each, and answers with the new one, or
/// with nothing, and then the words of the link stay.
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

/// A heading and the lines below it, down to the next heading of its level or a higher one.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Section<'a> {
    /// The heading; empty for what comes before the first.
    pub(super) title: &'a str,
    pub(super) body: String,
}

/// The sections of a level: 2 for `##`.
pub(super) fn sections(text: &str, level: usize) -> Vec<Section<'_>> {
    let mark = format!("{} ", "#".repeat(level));
    let mut found = vec![Section {
        title: "",
        body: String::new(),
    }];
    let mut open: Option<&str> = None;
    for line in text.split_inclusive('\n') {
        match (open, fence(line)) {
            (None, Some(signs)) => open = Some(signs),
            (Some(signs), Some(other)) if other.starts_with(signs) => open = None,
            _ => {}
        }
        match line.strip_prefix(&mark) {
            Some(title) if open.is_none() => found.push(Section {
                title: title.trim(),
                body: String::new(),
            }),
            _ => found
                .last_mut()
                .into_iter()
                .for_each(|last| last.body.push_str(line)),
        }
    }
    found
}

/// The name of a heading in an address: `#how-fast`.
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
    use super::{anchor, sections, with_links};

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
    fn sections_end_with_the_next_of_their_level() {
        let text = "# T\nbegin\n## A\na\n### B\n```sh\n## not one\n```\n## C d\n";
        let found = sections(text, 2);
        let titles: Vec<&str> = found.iter().map(|section| section.title).collect();
        assert_eq!(titles, ["", "A", "C d"]);
        assert_eq!(found[0].body, "# T\nbegin\n");
        assert_eq!(found[1].body, "a\n### B\n```sh\n## not one\n```\n");
        let texts: String = found[1..]
            .iter()
            .map(|it| format!("## {}\n{}", it.title, it.body))
            .collect();
        assert!(text.ends_with(&texts), "nothing is lost");
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
