//! Folding ranges: sections, objects with their sub-objects, comments.

use crate::file::File;
use crate::layout::{Layout, Section};
use crate::types::FoldingRange;

/// The folding ranges of a text.
pub(crate) fn of(file: &File, layout: &Layout) -> Vec<FoldingRange> {
    let line = |offset| file.text.line_at(offset) as u32;
    let range = |start, end| FoldingRange {
        start_line: start,
        end_line: end,
        kind: None,
    };
    let mut found = Vec::new();
    let is_object = |section: &Section| section.name.len() == 4 && section.index().is_some();
    for (at, section) in layout.sections.iter().enumerate() {
        let (start, end) = (line(section.header.start), line(section.end()));
        let members = layout.sections.iter().skip(at + 1);
        let members =
            members.take_while(|other| other.index() == section.index() && other.name.len() > 4);
        // An object is folded together with its sub-objects, because its own keys are few.
        match members.last().filter(|_| is_object(section)) {
            Some(last) => found.push(range(start, line(last.end()))),
            None if end > start => found.push(range(start, end)),
            None => {}
        }
    }
    comments(file, &mut found);
    found.sort_by_key(|range| (range.start_line, range.end_line));
    found
}

/// Consecutive lines of comments.
fn comments(file: &File, found: &mut Vec<FoldingRange>) {
    let is_comment = |line: usize| {
        let line = file.part(file.text.line(line)).trim_start();
        line.starts_with([';', '#'])
    };
    let mut start = None;
    for line in 0..=file.text.lines() {
        let inside = line < file.text.lines() && is_comment(line);
        match (inside, start) {
            (true, None) => start = Some(line),
            (false, Some(first)) => {
                if line - first > 1 {
                    found.push(FoldingRange {
                        start_line: first as u32,
                        end_line: line as u32 - 1,
                        kind: Some("comment"),
                    });
                }
                start = None;
            }
            _ => {}
        }
    }
}
