//! Excerpts of a rule's pair of files: the lines that differ, with their sections.

use od_eds::Document;
use od_eds::check::Pair;
use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Lines shown above and below a different line.
const CONTEXT: usize = 2;
/// Maximum number of lines of an example.
const LONGEST: usize = 24;

/// Lines of a section; its name is the first.
type Section<'a> = Vec<&'a str>;

/// The lines of both files: with the error, and fixed.
pub(super) fn lines(pair: &Pair) -> (String, String) {
    let (bad, fixed) = (Document::new(pair.bad), Document::new(pair.fixed));
    let (bad, fixed) = (sections(bad.text()), sections(fixed.text()));
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for op in capture_diff_slices(Algorithm::Myers, &bad, &fixed) {
        if matches!(op, DiffOp::Equal { .. }) {
            continue;
        }
        let (bad, fixed) = (&bad[op.old_range()], &fixed[op.new_range()]);
        before.extend(bad.iter().flat_map(|section| excerpt(section, fixed)));
        after.extend(fixed.iter().flat_map(|section| excerpt(section, bad)));
    }
    (shown(&before), shown(&after))
}

/// Splits the text before each `[`; an XDD is not split.
fn sections(text: &str) -> Vec<Section<'_>> {
    let mut sections: Vec<Section<'_>> = vec![Vec::new()];
    for line in text.lines().map(str::trim_end) {
        if line.starts_with('[') {
            sections.push(Vec::new());
        }
        if let Some(section) = sections.last_mut() {
            section.push(line);
        }
    }
    for section in &mut sections {
        while section.last().is_some_and(|line| line.is_empty()) {
            section.pop();
        }
    }
    sections.retain(|section| !section.is_empty());
    sections
}

/// The lines that the same section of the other file lacks, with the lines around them; the
/// whole section if the other file lacks it.
fn excerpt<'a>(section: &Section<'a>, others: &[Section<'_>]) -> Vec<&'a str> {
    let Some(other) = others.iter().find(|other| other[0] == section[0]) else {
        return section.clone();
    };
    let mut shown = vec![false; section.len()];
    shown[0] = section[0].starts_with('[');
    for op in capture_diff_slices(Algorithm::Myers, section, other) {
        if !matches!(op, DiffOp::Equal { .. }) {
            let lines = op.old_range();
            let end = section.len().min(lines.end + CONTEXT);
            shown[lines.start.saturating_sub(CONTEXT)..end].fill(true);
        }
    }
    let lines = section.iter().zip(shown);
    lines
        .filter_map(|(line, shown)| shown.then_some(*line))
        .collect()
}

fn shown(lines: &[&str]) -> String {
    let mut text = String::new();
    for line in lines.iter().take(LONGEST) {
        text.push_str(&format!("    {line}\n"));
    }
    if lines.len() > LONGEST {
        text.push_str("    …\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_lines_are_shown_with_their_section() {
        let pair = Pair {
            code: "E0000",
            bad: b"[a]\n1=1\n\n[b]\n1=1\n2=2\n3=3\n4=4\n5=5\n6=6\n",
            fixed: b"[a]\n1=1\n\n[b]\n1=1\n2=2\n3=3\n4=0\n5=5\n6=6\n\n[c]\n1=1\n",
        };
        let (before, after) = lines(&pair);
        assert_eq!(
            before,
            "    [b]\n    2=2\n    3=3\n    4=4\n    5=5\n    6=6\n"
        );
        let expected = "    [b]\n    2=2\n    3=3\n    4=0\n    5=5\n    6=6\n    [c]\n    1=1\n";
        assert_eq!(after, expected);
    }
}
