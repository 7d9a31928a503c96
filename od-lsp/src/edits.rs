//! From a text and the one that takes its place to edits.

use crate::file::File;
use crate::types::TextEdit;

/// The edit that makes `after` of the text of a file: of the lines between the first and the last
/// that differ. None if nothing does.
pub(crate) fn between(file: &File, after: &str) -> Vec<TextEdit> {
    let before = file.str();
    if before == after {
        return Vec::new();
    }
    let start = same(before.split_inclusive('\n'), after.split_inclusive('\n'));
    let (old, new) = (&before[start..], &after[start..]);
    let end = same(
        old.split_inclusive('\n').rev(),
        new.split_inclusive('\n').rev(),
    );
    vec![TextEdit {
        range: file.text.range(start..before.len() - end),
        new_text: new[..new.len() - end].to_owned(),
    }]
}

/// Number of bytes of the lines that are the same.
fn same<'a>(a: impl Iterator<Item = &'a str>, b: impl Iterator<Item = &'a str>) -> usize {
    let pairs = a.zip(b).take_while(|(a, b)| a == b);
    pairs.map(|(line, _)| line.len()).sum()
}
