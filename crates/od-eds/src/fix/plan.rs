//! Turns fixes into replacements that do not overlap.

use alloc::string::String;
use alloc::vec::Vec;

use super::{Action, Applicability, Edit, Fix};
use crate::finding::Finding;

/// A range of the text, and its replacement.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct TextEdit {
    /// First byte, counted from 0.
    pub start: u32,
    /// The byte after the last one; `start` if nothing is replaced.
    pub end: u32,
    /// Text to write there, with the line ends of the file.
    pub text: String,
}

impl TextEdit {
    /// Returns whether the result depends on the order of the two.
    fn meets(&self, other: &Self) -> bool {
        match (self.start == self.end, other.start == other.end) {
            // Two insertions keep their order.
            (true, true) => false,
            (true, false) => other.start < self.start && self.start < other.end,
            (false, true) => self.start < other.start && other.start < self.end,
            (false, false) => self.start < other.end && other.start < self.end,
        }
    }
}

/// A fix to apply.
pub(super) struct Choice {
    /// Index of its finding.
    pub(super) finding: usize,
    pub(super) edits: Vec<TextEdit>,
}

/// The replacements of all fixes that can be applied at once, in the order of the text.
///
/// Of two overlapping fixes the first is applied, the other in the next round.
pub fn plan(text: &str, findings: &[Finding], level: Applicability) -> Vec<TextEdit> {
    let chosen = choose(text, findings, level, |_| true).into_iter();
    let mut planned: Vec<TextEdit> = chosen.flat_map(|choice| choice.edits).collect();
    planned.sort_by_key(|edit| (edit.start, edit.end));
    planned
}

/// The fixes that can be applied at once, for findings that `may` be fixed.
pub(super) fn choose(
    text: &str,
    findings: &[Finding],
    level: Applicability,
    may: impl Fn(&Finding) -> bool,
) -> Vec<Choice> {
    let mut planned: Vec<TextEdit> = Vec::new();
    let mut chosen = Vec::new();
    let fixable = findings
        .iter()
        .enumerate()
        .filter_map(|(at, finding)| Some((at, finding, applies(finding, level)?)));
    for (finding, _, fix) in fixable.filter(|(_, finding, _)| may(finding)) {
        let Some(mut edits) = fix.text_edits(text) else {
            continue;
        };
        edits.retain(|edit| text.get(edit.start as usize..edit.end as usize) != Some(&edit.text));
        // They are sorted and do not overlap, so only the neighbours count.
        let near = |edit: &TextEdit| {
            let from = planned.partition_point(|other| other.end < edit.start);
            let end = edit.end;
            planned[from..]
                .iter()
                .take_while(move |other| other.start <= end)
        };
        let made = |edit: &TextEdit| near(edit).any(|other| other == edit);
        let free = |edit: &TextEdit| !near(edit).any(|other| other.meets(edit));
        if edits.iter().all(made) || !edits.iter().all(free) {
            continue;
        }
        for edit in &edits {
            // Sorted by position; after earlier insertions at the same one.
            let key = (edit.start, edit.end);
            let at = planned.partition_point(|other| (other.start, other.end) <= key);
            planned.insert(at, edit.clone());
        }
        chosen.push(Choice { finding, edits });
    }
    chosen
}

impl Fix {
    /// The replacements in `text`, which must be the text of the finding.
    ///
    /// `None` if it is another text.
    pub fn text_edits(&self, text: &str) -> Option<Vec<TextEdit>> {
        self.edits.iter().map(|edit| place(edit, text)).collect()
    }
}

/// Returns whether a run of this level fixes the finding.
fn applies(finding: &Finding, level: Applicability) -> Option<&Fix> {
    finding
        .fix
        .as_ref()
        .filter(|fix| fix.applicability <= level)
}

/// The text with these edits, which are sorted and do not overlap, as returned by [`plan`].
pub fn apply(text: &str, edits: &[TextEdit]) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        out.push_str(text.get(at..edit.start as usize).unwrap_or_default());
        out.push_str(&edit.text);
        at = edit.end as usize;
    }
    out.push_str(text.get(at..).unwrap_or_default());
    out
}

fn place(edit: &Edit, text: &str) -> Option<TextEdit> {
    let (start, end) = (edit.span.start as usize, edit.span.end as usize);
    let (before, _, behind) = (text.get(..start)?, text.get(start..end)?, text.get(end..)?);
    let is_end = |c: char| matches!(c, '\n' | '\r');
    // A byte order mark belongs to no line.
    let mark = text.len() - text.trim_start_matches('\u{FEFF}').len();
    let line_start = before.rfind(is_end).map_or(mark.min(start), |at| at + 1);
    let line_end = end + behind.find(is_end).unwrap_or(behind.len());
    let terminator = match &text.as_bytes()[line_end..] {
        [b'\r', b'\n', ..] => "\r\n",
        [b'\r', ..] => "\r",
        [b'\n', ..] => "\n",
        _ => "",
    };
    let line_feed = match terminator {
        "" => common(text),
        own => own,
    };
    let body = edit.text.replace('\n', line_feed);
    let (start, end, text) = match edit.action {
        Action::Replace => (start, end, body),
        Action::InsertAbove => (line_start, line_start, body + line_feed),
        Action::InsertBelow => (line_end, line_end, String::from(line_feed) + &body),
        Action::RemoveLine => (line_start, line_end + terminator.len(), body),
    };
    Some(TextEdit {
        start: u32::try_from(start).ok()?,
        end: u32::try_from(end).ok()?,
        text,
    })
}

/// Line end of the first line of the text.
fn common(text: &str) -> &'static str {
    match text.find(['\n', '\r']).map(|at| &text.as_bytes()[at..]) {
        Some([b'\r', b'\n', ..]) => "\r\n",
        Some([b'\r', ..]) => "\r",
        _ => "\n",
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::fix::Fix;
    use crate::span::Span;

    fn span(text: &str, part: &str) -> Span {
        let start = text.find(part).unwrap() as u32;
        Span {
            start,
            end: start + part.len() as u32,
            line: 1,
            column: 1,
        }
    }

    fn finding(fix: Fix) -> Finding {
        crate::rules::I0408.finding().fix(fix)
    }

    #[track_caller]
    fn check(text: &str, fixes: Vec<Fix>, expected: &str) {
        let findings: Vec<_> = fixes.into_iter().map(finding).collect();
        let edits = plan(text, &findings, Applicability::Unsafe);
        assert_eq!(apply(text, &edits), expected);
    }

    #[test]
    fn lines_keep_their_ends() {
        for feed in ["\n", "\r\n", "\r"] {
            let text = ["[a]", "b=1", "c=2", ""].join(feed);
            let b = span(&text, "1");
            let expected = ["[a]", "x", "b=1", "y", "c=2", ""].join(feed);
            check(
                &text,
                vec![Fix::safe().above(b, "x").below(b, "y")],
                &expected,
            );
            let expected = ["[a]", "c=2", ""].join(feed);
            check(&text, vec![Fix::safe().remove_line(b)], &expected);
            let expected = ["[a]", "b=7", ";z", "c=2", ""].join(feed);
            check(&text, vec![Fix::safe().replace(b, "7\n;z")], &expected);
        }
    }

    #[test]
    fn a_last_line_without_end_gets_none() {
        let text = "\u{FEFF}[a]\r\nb=1";
        let b = span(text, "1");
        check(
            text,
            vec![Fix::safe().below(b, "c=2")],
            "\u{FEFF}[a]\r\nb=1\r\nc=2",
        );
        check(text, vec![Fix::safe().remove_line(b)], "\u{FEFF}[a]\r\n");
        let a = span(text, "[a]");
        check(
            text,
            vec![Fix::safe().above(a, ";x")],
            "\u{FEFF};x\r\n[a]\r\nb=1",
        );
        check(text, vec![Fix::safe().remove_line(a)], "\u{FEFF}b=1");
    }

    #[test]
    fn the_first_of_two_overlapping_fixes_is_made() {
        let text = "a=1\nb=2\n";
        let (one, two) = (span(text, "1"), span(text, "2"));
        check(
            text,
            vec![
                Fix::safe().replace(one, "5"),
                Fix::safe().replace(two, "6").replace(one, "7"),
                Fix::safe().replace(one, "5"),
            ],
            "a=5\nb=2\n",
        );
        check(
            text,
            vec![Fix::safe().below(one, "x"), Fix::safe().below(one, "y")],
            "a=1\nx\ny\nb=2\n",
        );
        check(
            text,
            vec![Fix::safe().below(one, "x"), Fix::safe().below(one, "x")],
            "a=1\nx\nb=2\n",
        );
        check(
            text,
            vec![Fix::safe().remove_line(one), Fix::safe().below(one, "x")],
            "b=2\n",
        );
    }

    #[test]
    fn a_fix_without_a_place_is_not_made() {
        assert_eq!(finding(Fix::safe()).fix, None);
        let nowhere = Fix::safe().replace(Span::default(), "x");
        assert_eq!(finding(nowhere).fix, None);
        let token = Fix::safe().replace(crate::span::token(3), "x");
        assert_eq!(finding(token).fix, None);
        let far = span("a long text", "text");
        check("short", vec![Fix::safe().replace(far, "x")], "short");
        let unsafe_one = [finding(Fix::unsafe_fix().replace(span("a", "a"), "b"))];
        assert_eq!(plan("a", &unsafe_one, Applicability::Safe), []);
    }
}
