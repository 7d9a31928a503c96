//! The text of a file, with edits that leave all other bytes of the file unchanged.

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::ops::Range;

use crate::scan::encoding::{Encoding, decode, detect};
use crate::span::Span;

mod keys;
mod objects;
pub(crate) mod offsets;

/// Returns whether a text is XML, so an XDD or an XDC instead of an EDS.
pub fn is_xml(text: &str) -> bool {
    let text = text.trim_start_matches('\u{FEFF}');
    text.trim_start().starts_with('<')
}

/// A replacement of a range of a document.
///
/// `range` counts the bytes of [`Document::text`], as the [`Span`]s of the
/// findings of that text do. An empty range inserts, an empty text deletes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edit {
    /// Bytes to replace.
    pub range: Range<usize>,
    /// The new text.
    pub text: String,
}

impl Edit {
    /// Replaces `span` with `text`.
    pub fn replace(span: Span, text: impl Into<String>) -> Self {
        Self {
            range: span.start as usize..span.end as usize,
            text: text.into(),
        }
    }
}

/// Reason why a document was left unchanged.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum EditError {
    /// A range is outside the text, ends before its start, or cuts a character.
    NoPlace(Range<usize>),
    /// Two edits touch the same text.
    Overlap(Range<usize>, Range<usize>),
    /// The file's encoding has no such character.
    NoCharacter(char, Encoding),
    /// A name, key or value that does not fit into one line.
    NotOneLine(String),
    /// A section of this name is missing.
    NoSection(String),
    /// There is a section of this name already.
    SectionExists(String),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPlace(range) => write!(
                f,
                "bytes {} to {} are not a place in this text",
                range.start, range.end
            ),
            Self::Overlap(a, b) => write!(
                f,
                "two edits touch the same text: bytes {} to {} and {} to {}",
                a.start, a.end, b.start, b.end
            ),
            Self::NoCharacter(c, encoding) => write!(
                f,
                "`{c}` cannot be written in {encoding}, which is the encoding of this file"
            ),
            Self::NotOneLine(text) => write!(
                f,
                "{text:?} would not be read back as it is; line ends, `=` in a key and brackets in a name cannot be written"
            ),
            Self::NoSection(name) => write!(f, "section [{name}] is missing"),
            Self::SectionExists(name) => write!(f, "there is a section [{name}] already"),
        }
    }
}

impl core::error::Error for EditError {}

/// A file: all its bytes, its text, and edits that keep the rest.
///
/// Encoding, byte order mark, line ends, comments, order and all unknown
/// text stay unchanged; a file without edits is written as it was read.
///
/// ```
/// use od_eds::Document;
///
/// let mut file = Document::new(b"[1017]\r\nDefaultValue = 0 ; off\r\nOwn=\xB5\r\n".to_vec());
/// file.set("1017", "DefaultValue", "1000").unwrap();
/// assert_eq!(file.bytes(), b"[1017]\r\nDefaultValue = 1000 ; off\r\nOwn=\xB5\r\n");
/// ```
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Document {
    /// The bytes of the file; `None` if they are those of the text.
    own_bytes: Option<Vec<u8>>,
    text: String,
    encoding: Encoding,
    mark: usize,
    /// Name of the file on the disk, if it is known.
    pub(crate) file_name: Option<String>,
}

impl Document {
    /// The document of a file. Never fails: see [`decode`].
    pub fn new(bytes: impl Into<Vec<u8>>) -> Self {
        let bytes = bytes.into();
        let (encoding, mark) = detect(&bytes);
        let is_text = mark == 0 && matches!(encoding, Encoding::Ascii | Encoding::Utf8);
        let (own_bytes, text) = if is_text {
            // No second copy: a file can be large.
            match String::from_utf8(bytes) {
                Ok(text) => (None, text),
                Err(error) => {
                    let bytes = error.into_bytes();
                    let text = decode(&bytes).into_owned();
                    (Some(bytes), text)
                }
            }
        } else {
            let text = decode(&bytes).into_owned();
            (Some(bytes), text)
        };
        Self {
            own_bytes,
            text,
            encoding,
            mark,
            file_name: None,
        }
    }

    /// The document of a file with this name, which tells an EDS from a DCF; without a name, FileName does.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.file_name = Some(name.into());
        self
    }

    /// The text without a byte order mark, for [`parse`](crate::parse).
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The file.
    pub fn bytes(&self) -> &[u8] {
        self.own_bytes.as_deref().unwrap_or(self.text.as_bytes())
    }

    /// Encoding of its characters.
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Returns whether it begins with a byte order mark.
    pub fn has_mark(&self) -> bool {
        self.mark > 0
    }

    /// Place of the first byte that is invalid in the encoding.
    pub(crate) fn first_wrong(&self) -> Option<usize> {
        if self.encoding == Encoding::Utf8 {
            let error = core::str::from_utf8(&self.bytes()[self.mark..]).err()?;
            return Some(error.valid_up_to());
        }
        self.text.find(char::REPLACEMENT_CHARACTER)
    }

    /// Applies edits to the present text, in any order: all of them or none.
    ///
    /// # Errors
    ///
    /// A place outside the text, overlapping edits, or a character that the encoding of the file
    /// lacks; then nothing has changed. Two insertions at one place keep
    /// their order.
    pub fn apply(&mut self, edits: &[Edit]) -> Result<(), EditError> {
        let mut order: Vec<&Edit> = edits.iter().collect();
        order.sort_by_key(|edit| (edit.range.start, edit.range.end));
        for pair in order.windows(2) {
            if pair[1].range.start < pair[0].range.end {
                return Err(EditError::Overlap(
                    pair[0].range.clone(),
                    pair[1].range.clone(),
                ));
            }
        }
        let mut text = String::with_capacity(self.text.len());
        let mut bytes = self.bytes()[..self.mark].to_owned();
        let mut place = Place {
            document: self,
            text: 0,
            byte: self.mark,
        };
        for edit in order {
            let Range { start, end } = edit.range;
            if self.text.get(start..end).is_none() {
                return Err(EditError::NoPlace(edit.range.clone()));
            }
            place.copy_to(start, &mut text, &mut bytes);
            text.push_str(&edit.text);
            for c in edit.text.chars() {
                if !self.encoding.push(c, &mut bytes) {
                    return Err(EditError::NoCharacter(c, self.encoding));
                }
            }
            place.skip_to(end);
        }
        place.copy_to(self.text.len(), &mut text, &mut bytes);
        if self.encoding == Encoding::Ascii && !bytes.is_ascii() {
            self.encoding = Encoding::Utf8;
        }
        self.own_bytes = (bytes != text.as_bytes()).then_some(bytes);
        self.text = text;
        Ok(())
    }

    /// Returns whether the bytes of the file are those of the text, after the byte order mark.
    fn is_plain(&self) -> bool {
        self.bytes().len() - self.mark == self.text.len()
            && matches!(self.encoding, Encoding::Ascii | Encoding::Utf8)
    }

    /// Number of bytes of a piece of the text in the file, where it begins at `byte`.
    fn len_of(&self, text: Range<usize>, byte: usize) -> usize {
        let mut at = byte;
        for c in self.text[text].chars() {
            let (read, len) = self.encoding.next(&self.bytes()[at..]);
            debug_assert_eq!(read, c);
            at += len;
        }
        at - byte
    }

    /// Line end of the line at `at`, otherwise the first line end of the file.
    fn line_end(&self, at: usize) -> &'static str {
        let behind = &self.text[at..];
        let found = behind
            .find(['\r', '\n'])
            .map(|end| &behind[end..])
            .or_else(|| self.text.find(['\r', '\n']).map(|end| &self.text[end..]));
        match found {
            Some(end) if end.starts_with("\r\n") => "\r\n",
            Some(end) if end.starts_with('\r') => "\r",
            _ => "\n",
        }
    }

    /// Start of the line after the one at `at`.
    fn next_line(&self, at: usize) -> usize {
        let behind = &self.text[at..];
        match behind.find(['\r', '\n']) {
            None => self.text.len(),
            Some(end) if behind[end..].starts_with("\r\n") => at + end + 2,
            Some(end) => at + end + 1,
        }
    }

    /// Lines to insert after the line at `at`.
    fn lines_behind(&self, at: usize, lines: &[String]) -> Edit {
        let end = self.line_end(at);
        let start = self.next_line(at);
        let mut text = lines.join(end);
        if start == 0 || self.text[..start].ends_with(['\r', '\n']) {
            text.push_str(end)
        } else {
            // If the last line has no line end, the new last line has none either.
            text.insert_str(0, end)
        }
        Edit {
            range: start..start,
            text,
        }
    }
}

/// A place in a document, both in its text and in its bytes.
struct Place<'a> {
    document: &'a Document,
    text: usize,
    byte: usize,
}

impl Place<'_> {
    /// The byte of a later place in the text.
    fn find(&self, text: usize) -> usize {
        if self.document.is_plain() {
            text + self.document.mark
        } else {
            self.byte + self.document.len_of(self.text..text, self.byte)
        }
    }

    fn copy_to(&mut self, to: usize, text: &mut String, bytes: &mut Vec<u8>) {
        let byte = self.find(to);
        text.push_str(&self.document.text[self.text..to]);
        bytes.extend_from_slice(&self.document.bytes()[self.byte..byte]);
        (self.text, self.byte) = (to, byte);
    }

    fn skip_to(&mut self, to: usize) {
        self.byte = self.find(to);
        self.text = to;
    }
}

/// A part of a line that must be read back unchanged.
fn one_line(text: &str, forbidden: &[char]) -> Result<(), EditError> {
    let fits = !text.contains(['\r', '\n']) && !text.contains(forbidden) && text == text.trim();
    if fits {
        Ok(())
    } else {
        Err(EditError::NotOneLine(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_encoding(text: &str, encoding: Encoding, mark: &[u8]) -> Vec<u8> {
        let mut bytes = mark.to_vec();
        for c in text.chars() {
            assert!(encoding.push(c, &mut bytes));
        }
        bytes
    }

    #[test]
    fn text_without_edits_is_unchanged() {
        for bytes in [
            &b"[a]\nx=1"[..],
            b"\xEF\xBB\xBF[a]\r\nx=\xC2\xB5\xB5\r\r\n",
            b"\xFF\xFE[\0a\0]\0\n",
            b"\xFE\xFF",
            b"",
            b"\x1A\0\xFF junk",
        ] {
            let document = Document::new(bytes);
            assert_eq!(document.bytes(), bytes);
            let mut edited = document.clone();
            edited.apply(&[]).unwrap();
            assert_eq!(edited, document);
        }
    }

    #[test]
    fn edits_are_in_the_encoding_of_the_file() {
        use Encoding::*;
        let before = "[é]\r\nx=µ\r\ny=2\r\n";
        let after = "[é]\r\nx=ä1\r\ny=\r\n";
        for (encoding, mark) in [
            (Utf8, &b""[..]),
            (Utf8, b"\xEF\xBB\xBF"),
            (Windows1252, b""),
            (Utf16Le, b"\xFF\xFE"),
            (Utf16Be, b"\xFE\xFF"),
            (Utf16Le, b""),
        ] {
            let mut document = Document::new(in_encoding(before, encoding, mark));
            assert_eq!((document.encoding(), document.text()), (encoding, before));
            let edit = |piece: &str, text: &str| {
                let start = before.find(piece).unwrap();
                Edit {
                    range: start..start + piece.len(),
                    text: text.into(),
                }
            };
            document.apply(&[edit("2", ""), edit("µ", "ä1")]).unwrap();
            assert_eq!(document.bytes(), in_encoding(after, encoding, mark));
            assert_eq!(document.text(), after);
        }
    }

    #[test]
    fn bytes_that_are_no_character_are_kept() {
        let mut document = Document::new(&b"\xFF\xFEa\0\0\xD8b\0c"[..]);
        assert_eq!(document.text(), "a\u{FFFD}b\u{FFFD}");
        let at = document.text().find('b').unwrap();
        let edit = Edit {
            range: at..at + 1,
            text: "B".into(),
        };
        document.apply(&[edit]).unwrap();
        assert_eq!(document.bytes(), b"\xFF\xFEa\0\0\xD8B\0c");
    }

    #[test]
    fn an_impossible_edit_changes_nothing() {
        let document = Document::new(&b"x=\xB5\n"[..]);
        let edit = |range: Range<usize>, text: &str| Edit {
            range,
            text: text.into(),
        };
        for (edits, error) in [
            (vec![edit(0..9, "")], EditError::NoPlace(0..9)),
            (vec![edit(3..4, "")], EditError::NoPlace(3..4)),
            (
                vec![edit(1..2, ""), edit(0..2, "")],
                EditError::Overlap(0..2, 1..2),
            ),
            (
                vec![edit(0..1, "y"), edit(2..2, "😀")],
                EditError::NoCharacter('😀', Encoding::Windows1252),
            ),
        ] {
            let mut edited = document.clone();
            assert_eq!(edited.apply(&edits), Err(error));
            assert_eq!(edited, document);
        }
    }

    use alloc::vec;
}
