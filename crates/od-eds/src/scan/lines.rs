//! Finds the sections, keys and values of a text, with their places.
//!
//! INI parsers report no places, and stop at the first unknown line. This scanner continues: a line
//! that is not plain INI is a [`Fault`], which the reader turns into a finding.

use alloc::borrow::Cow;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::scan::either;
use crate::scan::forms::OBJECT_KEYS;
use crate::scan::section::{Text, TextSection};
use crate::span::{Span, Spanned};

/// Maximum number of bytes of a line, and of a value of an XDD: half of it as the bytes of a DOMAIN.
pub(crate) const LONGEST: usize = 1 << 20;
/// Maximum number of sections of a text. Large device files have 2,000.
const SECTIONS: usize = 50_000;
/// Maximum number of headers and keys of a text.
const LINES: usize = 200_000;

/// Returns whether a text has more lines or sections, or a longer line, than odkit reads.
#[cfg(feature = "tools")]
pub(crate) fn is_too_large(text: &str) -> bool {
    let (mut lines, mut sections) = (0, 0);
    text.lines().any(|line| {
        lines += 1;
        sections += usize::from(line.trim_start().starts_with('['));
        lines > LINES || sections > SECTIONS || line.len() > LONGEST
    })
}

/// Scanning a text, line by line.
struct Scan<'a, 'f> {
    /// Sections in file order, with duplicates.
    sections: Vec<TextSection<'a>>,
    /// Number of headers and keys.
    count: usize,
    /// Receives the lines that are ignored, or not read as written, in file order.
    fault: &'f mut dyn FnMut(&Fault<'a>),
}

/// A line that is not plain INI.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Fault<'a> {
    /// A line that git writes between two versions; ignored.
    Conflict(Spanned<&'a str>),
    /// Not a section, a `key=value` line or a comment; ignored.
    NoPair(Spanned<&'a str>),
    /// A key of an object and its value, separated by blanks only.
    NoSign {
        at: Span,
        key: &'a str,
        value: &'a str,
    },
    /// A line with nothing before its `=`; ignored.
    NoKey(Spanned<&'a str>),
    /// A header without a closing bracket; its name ends before a comment, or with the line.
    Open { line: Span, name: Spanned<&'a str> },
    /// Text after a header; ignored.
    Behind {
        name: &'a str,
        text: Spanned<&'a str>,
    },
    /// A header with nothing between its brackets.
    NoName(Span),
    /// A key before the first section, with its line.
    NoSection { line: Span, key: &'a str },
    /// A line that is too long; ignored.
    Long(Span),
    /// The first header or key beyond the limit; it is ignored with everything after it.
    Many {
        at: Span,
        most: usize,
        of: &'static str,
    },
    /// A line with `:` instead of `=`.
    Colon {
        at: Span,
        key: &'a str,
        value: &'a str,
    },
}

/// One line with its place.
pub(crate) struct Line<'a> {
    pub(crate) text: &'a str,
    start: usize,
    pub(crate) number: u32,
}

impl<'a> Line<'a> {
    /// The span of `part`, which must be a piece of this line.
    pub(crate) fn span(&self, part: &str) -> Span {
        let within = part.as_ptr() as usize - self.text.as_ptr() as usize;
        let before = &self.text[..within];
        let column = if before.is_ascii() {
            before.len()
        } else {
            before.chars().count()
        };
        Span {
            start: (self.start + within) as u32,
            end: (self.start + within + part.len()) as u32,
            line: self.number,
            column: column as u32 + 1,
        }
    }

    fn spanned(&self, part: &'a str) -> Spanned<&'a str> {
        Spanned::new(part, self.span(part))
    }

    fn text(&self, part: &'a str) -> Text<'a> {
        Spanned::new(Cow::Borrowed(part), self.span(part))
    }
}

/// The character at a byte of a text.
pub(crate) fn span(text: &str, at: usize) -> Span {
    let found = lines(text)
        .take_while(|line| line.start <= at)
        .last()
        .filter(|line| at <= line.start + line.text.len());
    match found {
        Some(line) => {
            let behind = &line.text[at - line.start..];
            let len = behind.chars().next().map_or(0, char::len_utf8);
            line.span(&behind[..len])
        }
        None => Span::default(),
    }
}

/// The lines of a text; `\n`, `\r\n` and `\r` end one. A byte order mark before it is skipped.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let body = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let mut next = text.len() - body.len();
    (1..).zip(with_ends(body)).map(move |(number, line)| {
        let start = next;
        next += line.len();
        Line {
            text: line.trim_end_matches(['\n', '\r']),
            start,
            number,
        }
    })
}

/// The lines of a text for a reader that ends lines only at line feeds, numbered as by [`lines`].
#[cfg(feature = "tools")]
pub(crate) fn lines_by_newline(text: &str) -> impl Iterator<Item = Line<'_>> {
    let body = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let (mut start, mut number) = (text.len() - body.len(), 1);
    body.split_inclusive('\n').map(move |line| {
        let text = line.strip_suffix('\n').unwrap_or(line);
        let found = Line {
            text,
            start,
            number,
        };
        start += line.len();
        number += with_ends(line).count() as u32;
        found
    })
}

/// The lines of a text, each with its end.
pub(crate) fn with_ends(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    core::iter::from_fn(move || {
        let len = match either(rest, [b'\n', b'\r']) {
            Some(at) if rest[at..].starts_with("\r\n") => at + 2,
            Some(at) => at + 1,
            None => rest.len(),
        };
        let (line, behind) = rest.split_at(len);
        rest = behind;
        (!line.is_empty()).then_some(line)
    })
}

/// Makes a comment line of a text. A text that odkit would read as one of its own comments gets a
/// second `;`.
pub(crate) fn comment(text: &str) -> String {
    let starts = |word: &str| {
        let own = text.trim_start().get(..word.len());
        own.is_some_and(|own| own.eq_ignore_ascii_case(word))
    };
    let is_read = ["StorageLocation", "odkit-allow"].into_iter().any(starts);
    format!("{}{text}", if is_read { ";;" } else { ";" })
}

/// The sections of a text, in file order, with duplicates; a byte order mark is skipped.
pub fn sections(text: &str) -> Vec<TextSection<'_>> {
    scan(text, &mut |_| {})
}

/// As [`sections`]; `fault` receives the lines that are not plain INI, in file order.
pub(crate) fn scan<'a>(text: &'a str, fault: &mut dyn FnMut(&Fault<'a>)) -> Vec<TextSection<'a>> {
    let mut scan = Scan {
        sections: Vec::new(),
        count: 0,
        fault,
    };
    for line in lines(text) {
        if !scan.has_room(&line) {
            break;
        }
        scan.line(&line);
    }
    scan.sections
}

impl<'a> Scan<'a, '_> {
    /// Returns whether the limits of a text allow another line.
    fn has_room(&mut self, line: &Line<'a>) -> bool {
        let (most, of) = if self.count >= LINES {
            (LINES, "lines")
        } else if self.sections.len() >= SECTIONS && line.text.trim_start().starts_with('[') {
            (SECTIONS, "sections")
        } else {
            return true;
        };
        let at = line.span(&line.text[..0]);
        (self.fault)(&Fault::Many { at, most, of });
        false
    }

    fn line(&mut self, line: &Line<'a>) {
        let trimmed = line.text.trim();
        match trimmed.as_bytes().first() {
            None => {}
            Some(b'<' | b'=' | b'>' | b'|') if is_conflict(line.text) => {
                (self.fault)(&Fault::Conflict(line.spanned(trimmed)));
            }
            _ if line.text.len() > LONGEST => (self.fault)(&Fault::Long(line.span(trimmed))),
            Some(b';' | b'#') => self.comment(line, trimmed),
            Some(b'[') => self.header(line, trimmed),
            Some(_) => self.pair(line, trimmed),
        }
    }

    /// A comment: ignored, unless it says where a value is stored.
    fn comment(&mut self, line: &Line<'a>, trimmed: &'a str) {
        let body = trimmed[1..].trim_start();
        let Some((key, value)) = body.split_once('=') else {
            return;
        };
        if !key.trim_end().eq_ignore_ascii_case("StorageLocation") {
            return;
        }
        if let Some(section) = self.sections.last_mut()
            && section.storage.is_none()
        {
            section.storage = Some(line.text(value.trim()));
        }
    }

    fn header(&mut self, line: &Line<'a>, trimmed: &'a str) {
        let inside = &trimmed[1..];
        let (name, behind) = match inside.split_once(']') {
            Some((name, behind)) => (name.trim(), behind.trim()),
            None => {
                let name = inside.split([';', '#']).next().unwrap_or(inside).trim();
                (self.fault)(&Fault::Open {
                    line: line.span(trimmed),
                    name: line.spanned(name),
                });
                (name, "")
            }
        };
        if !behind.is_empty() {
            let text = line.spanned(behind);
            (self.fault)(&Fault::Behind { name, text });
        }
        if name.is_empty() {
            (self.fault)(&Fault::NoName(line.span(trimmed)));
        }
        let whole = &trimmed[..trimmed.len() - behind.len()];
        let header = line.span(whole.trim_end());
        self.count += 1;
        self.sections
            .push(TextSection::new(line.text(name), header));
    }

    fn pair(&mut self, line: &Line<'a>, trimmed: &'a str) {
        let Some(at) = either(trimmed, [b'=', b':']) else {
            match without_sign(trimmed) {
                Some((key, value)) => {
                    let at = &trimmed[key.len()..trimmed.len() - value.len()];
                    let at = line.span(at);
                    (self.fault)(&Fault::NoSign { at, key, value });
                    let pair = (line.text(key), line.text(value));
                    if let Some(section) = self.sections.last_mut() {
                        add(section, pair);
                    }
                }
                None => (self.fault)(&Fault::NoPair(line.spanned(trimmed))),
            }
            return;
        };
        let (key, value) = (trimmed[..at].trim_end(), trimmed[at + 1..].trim_start());
        if key.is_empty() {
            (self.fault)(&Fault::NoKey(line.spanned(trimmed)));
            return;
        }
        if trimmed[at..].starts_with(':') {
            let at = line.span(&trimmed[at..=at]);
            (self.fault)(&Fault::Colon { at, key, value });
        }
        self.count += 1;
        let pair = (line.text(key), line.text(value));
        match self.sections.last_mut() {
            Some(section) => add(section, pair),
            None => {
                let start = line.span(&trimmed[..0]);
                let line = line.span(trimmed);
                (self.fault)(&Fault::NoSection { line, key });
                let mut section = TextSection::new(Spanned::new(Cow::Borrowed(""), start), start);
                section.pairs.push(pair);
                self.sections.push(section);
            }
        }
    }
}

/// Adds a key with its value; memory is reserved for the usual number of keys.
fn add<'a>(section: &mut TextSection<'a>, pair: (Text<'a>, Text<'a>)) {
    if section.pairs.is_empty() {
        section.pairs.reserve(8);
    }
    section.pairs.push(pair);
}

/// `AccessType rww`: a key of an object and one word.
fn without_sign(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once(char::is_whitespace)?;
    let value = value.trim_start();
    let known = OBJECT_KEYS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(key));
    (known && !value.contains(char::is_whitespace)).then_some((key, value))
}

/// Returns whether the line is a mark of a merge conflict: seven equal signs or brackets, alone or
/// before a name.
pub(crate) fn is_conflict(line: &str) -> bool {
    let marks = ["<<<<<<<", "=======", ">>>>>>>", "|||||||"];
    let rest = marks.iter().find_map(|mark| line.strip_prefix(mark));
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The span of every key and value contains it.
    #[track_caller]
    fn check<'a>(text: &'a str, expected: &[(&str, &[(&str, &str)])]) -> Vec<Fault<'a>> {
        let mut faults = Vec::new();
        let sections = scan(text, &mut |fault| faults.push(*fault));
        let found: Vec<_> = sections
            .iter()
            .map(|s| {
                let pairs = s.pairs.iter().map(|(key, value)| (&***key, &***value));
                (&**s.name, pairs.collect::<Vec<_>>())
            })
            .collect();
        let expected: Vec<_> = expected.iter().map(|(n, p)| (*n, p.to_vec())).collect();
        assert_eq!(found, expected);
        for section in &sections {
            for part in core::iter::once(&section.name)
                .chain(section.pairs.iter().flat_map(|(key, value)| [key, value]))
            {
                let Span { start, end, .. } = part.span;
                assert_eq!(&text[start as usize..end as usize], **part);
            }
        }
        faults
    }

    #[test]
    fn sections_keys_and_values() {
        let faults = check(
            "[FileInfo]\r\n a = b ; c \r\n\r\n;x=y\r\n#z\r\n [1000] \nk=\n",
            &[("FileInfo", &[("a", "b ; c")]), ("1000", &[("k", "")])],
        );
        assert!(faults.is_empty());
    }

    #[test]
    fn unknown_lines_are_reported() {
        let faults = check(
            "a=1\n[x\nfoo\n=3\n[y] # more\nb:2\nk=v\\\n[z\\]\nq\\=1",
            &[
                ("", &[("a", "1")]),
                ("x", &[]),
                ("y", &[("b", "2"), ("k", "v\\")]),
                ("z\\", &[("q\\", "1")]),
            ],
        );
        assert!(matches!(
            faults[..],
            [
                Fault::NoSection { key: "a", .. },
                Fault::Open { .. },
                Fault::NoPair(Spanned { value: "foo", .. }),
                Fault::NoKey(_),
                Fault::Behind { name: "y", .. },
                Fault::Colon {
                    key: "b",
                    value: "2",
                    ..
                },
            ]
        ));
    }

    #[test]
    fn columns_count_characters() {
        let text = "[a]\nGröße = µ\r[b]";
        let sections = sections(text);
        let value = &sections[0].pairs[0].1;
        assert_eq!((value.span.line, value.span.column), (2, 9));
        assert_eq!(sections[1].header.line, 3);
    }

    #[test]
    fn the_storage_comment_belongs_to_its_section() {
        let sections =
            sections("; StorageLocation=X\n[a]\n;StorageLocation = RAM\n;StorageLocation=ROM\n[b]");
        let storage = sections[0].storage.as_ref();
        assert_eq!(storage.map(|text| &*text.value), Some("RAM"));
        assert_eq!(sections[1].storage, None);
    }
}
