//! Converts places of a document's text into bytes of the file.

use alloc::vec::Vec;

use super::Document;
use crate::span::Span;

/// Bytes of text between two known places.
const STEP: usize = 512;

/// Place of a document's text in the file, with its byte order mark and encoding.
#[derive(Clone, Debug)]
pub struct Offsets<'a> {
    document: &'a Document,
    /// A place in the text, and the same place in the file, every [`STEP`] bytes.
    known: Vec<(usize, usize)>,
}

impl Document {
    /// Converts the places of findings into bytes of the file on the disk.
    ///
    /// ```
    /// use od_eds::Document;
    ///
    /// let file = Document::new(&b"[a]\nx=\xB5\nfoo\n"[..]);
    /// let foo = file.text().find("foo").unwrap();
    /// assert_eq!((foo, file.offsets().byte(foo)), (9, 8));
    /// assert_eq!(&file.bytes()[8..11], b"foo");
    /// ```
    pub fn offsets(&self) -> Offsets<'_> {
        let mut known = Vec::new();
        let (mut at, mut byte) = (0, self.mark);
        if !self.is_plain() {
            while at < self.text.len() {
                let step = (at + STEP).min(self.text.len());
                let end = (step..=self.text.len()).find(|end| self.text.is_char_boundary(*end));
                known.push((at, byte));
                let end = end.unwrap_or(self.text.len());
                byte += self.len_of(at..end, byte);
                at = end;
            }
        }
        Offsets {
            document: self,
            known,
        }
    }
}

impl Offsets<'_> {
    /// The byte of the file at a byte of the text. A place inside a character is its
    /// start, a place after the text the end of the file.
    pub fn byte(&self, at: usize) -> usize {
        let document = self.document;
        let at = (0..=at.min(document.text.len()))
            .rev()
            .find(|at| document.text.is_char_boundary(*at))
            .unwrap_or(0);
        let near = self.known.partition_point(|(text, _)| *text <= at);
        match near.checked_sub(1).and_then(|near| self.known.get(near)) {
            Some((text, byte)) => byte + document.len_of(*text..at, *byte),
            None => at + document.mark,
        }
    }

    /// Converts a span of the text into one of the file; line and column stay.
    #[must_use]
    pub fn span(&self, span: Span) -> Span {
        let byte = |at: u32| self.byte(at as usize) as u32;
        Span {
            start: byte(span.start),
            end: byte(span.end),
            ..span
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::String;

    use super::*;
    use crate::scan::encoding::Encoding;

    #[test]
    fn every_character_has_its_place_in_the_file() {
        let text: String = "[é]\r\nx=µ😀\n".repeat(300);
        for (encoding, mark) in [
            (Encoding::Utf8, &b""[..]),
            (Encoding::Utf8, b"\xEF\xBB\xBF"),
            (Encoding::Windows1252, b""),
            (Encoding::Utf16Le, b"\xFF\xFE"),
            (Encoding::Utf16Be, b"\xFE\xFF"),
        ] {
            let mut bytes = mark.to_vec();
            let mut expected = Vec::new();
            for c in text.chars() {
                let before = bytes.len();
                if encoding.push(c, &mut bytes) {
                    expected.push((c, before));
                }
            }
            let document = Document::new(bytes);
            assert_eq!(document.encoding(), encoding);
            let offsets = document.offsets();
            let found = document.text().char_indices();
            let found: Vec<_> = found.map(|(at, c)| (c, offsets.byte(at))).collect();
            assert_eq!(found, expected, "{encoding}");
            let end = document.text().len();
            assert_eq!(offsets.byte(end), document.bytes().len());
            assert_eq!(offsets.byte(end + 9), document.bytes().len());
        }
        // A UTF-8 file with one invalid byte.
        let document = Document::new(&b"\xEF\xBB\xBF\xC2\xB5\xB5a"[..]);
        let places: Vec<_> = (0..=5).map(|at| document.offsets().byte(at)).collect();
        assert_eq!(places, [3, 3, 5, 5, 6, 7]);
    }
}
