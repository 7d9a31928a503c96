//! A text with positions as the client counts them: by line, and by character in the agreed unit.

use crate::types::{Position, Range};

/// The unit of [`Position::character`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum Unit {
    Utf8,
    /// The unit of a client that names none.
    #[default]
    Utf16,
}

impl Unit {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "utf-8",
            Self::Utf16 => "utf-16",
        }
    }

    const fn len(self, c: char) -> usize {
        match self {
            Self::Utf8 => c.len_utf8(),
            Self::Utf16 => c.len_utf16(),
        }
    }

    /// Length of a text without its line ends.
    pub(crate) fn count(self, text: &str) -> u32 {
        let count = match self {
            _ if text.is_ascii() => text.len(),
            unit => text.chars().map(|c| unit.len(c)).sum(),
        };
        count as u32
    }
}

/// A text and the byte position of each line; `\n`, `\r\n` and `\r` end a line.
#[derive(Clone, Debug, Default)]
pub(crate) struct Text {
    content: String,
    starts: Vec<usize>,
    unit: Unit,
}

impl Text {
    pub(crate) fn new(content: String, unit: Unit) -> Self {
        let starts = starts(&content);
        Self {
            content,
            starts,
            unit,
        }
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.content
    }

    pub(crate) const fn unit(&self) -> Unit {
        self.unit
    }

    /// Number of the line at a byte, from 0.
    pub(crate) fn line_at(&self, offset: usize) -> usize {
        let behind = self.starts.partition_point(|start| *start <= offset);
        behind.saturating_sub(1)
    }

    /// The byte range of a line without its end; an empty one after the text.
    pub(crate) fn line(&self, number: usize) -> std::ops::Range<usize> {
        let len = self.content.len();
        let Some(&start) = self.starts.get(number) else {
            return len..len;
        };
        let end = self.starts.get(number + 1).copied().unwrap_or(len);
        let body = self.content.get(start..end).unwrap_or_default();
        start..start + body.trim_end_matches(['\n', '\r']).len()
    }

    /// Number of its lines.
    pub(crate) fn lines(&self) -> usize {
        self.starts.len()
    }

    /// The position of a byte; inside a character, the position of that character.
    pub(crate) fn position(&self, offset: usize) -> Position {
        let mut offset = offset.min(self.content.len());
        while !self.content.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line_at(offset);
        let start = self.starts.get(line).copied().unwrap_or(0);
        let before = self.content.get(start..offset).unwrap_or_default();
        Position {
            line: line as u32,
            character: self.unit.count(before),
        }
    }

    /// The byte at a position; for a position after the end of a line or of the text, that end.
    pub(crate) fn offset(&self, position: Position) -> usize {
        let line = self.line(position.line as usize);
        let mut left = position.character as usize;
        let body = self.content.get(line.clone()).unwrap_or_default();
        for (at, c) in body.char_indices() {
            match left.checked_sub(self.unit.len(c)) {
                // At it, or inside.
                None => return line.start + at,
                Some(rest) => left = rest,
            }
        }
        line.end
    }

    /// The positions of a byte range.
    pub(crate) fn range(&self, bytes: std::ops::Range<usize>) -> Range {
        Range {
            start: self.position(bytes.start),
            end: self.position(bytes.end),
        }
    }

    /// The byte range between two positions, in either order.
    pub(crate) fn bytes(&self, range: Range) -> std::ops::Range<usize> {
        let (a, b) = (self.offset(range.start), self.offset(range.end));
        a.min(b)..a.max(b)
    }

    /// Replaces a range, or everything, with `text`.
    pub(crate) fn change(&mut self, range: Option<Range>, text: &str) {
        let Some(range) = range else {
            *self = Self::new(text.into(), self.unit);
            return;
        };
        let bytes = self.bytes(range);
        // Count the lines of the range again, with the line before: its `\r` may be followed by a new `\n`.
        let first = self.line_at(bytes.start).saturating_sub(1);
        let behind = self.starts.partition_point(|start| *start <= bytes.end);
        for start in &mut self.starts[behind..] {
            *start = *start - bytes.len() + text.len();
        }
        self.content.replace_range(bytes, text);
        let from = self.starts.get(first).copied().unwrap_or(0);
        let to = self.starts.get(behind).copied();
        let piece = &self.content[from..to.unwrap_or(self.content.len())];
        let new = starts(piece).into_iter().map(|start| from + start);
        let new = new.filter(|start| Some(*start) != to);
        let new: Vec<usize> = new.collect();
        self.starts.splice(first..behind, new);
    }
}

fn starts(text: &str) -> Vec<usize> {
    let bytes = text.as_bytes();
    let mut starts = Vec::with_capacity(bytes.len() / 16 + 1);
    starts.push(0);
    for (at, byte) in bytes.iter().enumerate() {
        let ends = match byte {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        if ends {
            starts.push(at + 1);
        }
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(line: u32, character: u32) -> Position {
        Position { line, character }
    }

    #[test]
    fn positions_are_correct_in_every_unit() {
        let content = "a\r\nµ😀b\rz";
        for (unit, b) in [(Unit::Utf8, 6), (Unit::Utf16, 3)] {
            let text = Text::new(content.into(), unit);
            let byte = content.find('b').unwrap();
            assert_eq!(text.position(byte), at(1, b), "{unit:?}");
            assert_eq!(text.offset(at(1, b)), byte, "{unit:?}");
            assert_eq!(text.offset(at(1, 99)), byte + 1, "{unit:?}");
            assert_eq!(text.offset(at(0, 9)), 1);
            assert_eq!(text.offset(at(9, 9)), content.len());
            assert_eq!(text.position(content.len()), at(2, 1));
        }
        // Half of a surrogate pair has the position of the pair.
        let text = Text::new(content.into(), Unit::Utf16);
        assert_eq!(text.offset(at(1, 2)), content.find('😀').unwrap());
    }

    #[test]
    fn changes_move_lines() {
        let mut text = Text::new("[a]\nx=1\n".into(), Unit::Utf16);
        let (start, end) = (at(1, 2), at(1, 3));
        text.change(Some(Range { start, end }), "2\ny=µ");
        assert_eq!(text.as_str(), "[a]\nx=2\ny=µ\n");
        assert_eq!(text.lines(), 4);
        // A reversed range, and one far outside.
        let range = Range {
            start: at(99, 0),
            end: at(2, 0),
        };
        text.change(Some(range), "");
        assert_eq!(text.as_str(), "[a]\nx=2\n");
        text.change(None, "b");
        assert_eq!((text.as_str(), text.lines()), ("b", 1));
    }

    #[test]
    fn changed_lines_are_those_of_the_new_text() {
        let pieces = ["", "\r", "\n", "\r\n", "x", "x\ry\n\nz", "µ\r"];
        for content in ["", "a", "a\r\nb\r\rc\n\nd\r", "\n\ré\r\n"] {
            let ends: Vec<usize> = (0..=content.len())
                .filter(|at| content.is_char_boundary(*at))
                .collect();
            for (number, from) in ends.iter().enumerate() {
                for (to, piece) in ends[number..].iter().flat_map(|to| pieces.map(|p| (to, p))) {
                    let mut text = Text::new(content.into(), Unit::Utf16);
                    let range = text.range(*from..*to);
                    let bytes = text.bytes(range);
                    text.change(Some(range), piece);
                    let mut whole = content.to_owned();
                    whole.replace_range(bytes, piece);
                    assert_eq!(text.as_str(), whole);
                    assert_eq!(
                        text.starts,
                        starts(&whole),
                        "{content:?} {range:?} {piece:?}"
                    );
                }
            }
        }
    }
}
