//! Where everything stands: sections, keys and values line by line.
//!
//! INI readers report no places, and give up at the first line they do not know. This
//! scanner finds the places and names the lines that are neither section, key nor
//! comment; what it makes of all others is compared with rust-ini in a test.

use alloc::format;
use alloc::vec::Vec;

use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::span::{Span, Spanned};

/// A section as it stands in the text.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct RawSection<'a> {
    /// The trimmed text between the brackets; empty for the keys before the first section.
    pub(crate) name: Spanned<&'a str>,
    /// The brackets with what is between them.
    pub(crate) header: Span,
    /// Keys and values, trimmed.
    pub(crate) pairs: Vec<RawPair<'a>>,
    /// The first `;StorageLocation=` comment.
    pub(crate) storage: Option<Spanned<&'a str>>,
}

/// A line `key=value`.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct RawPair<'a> {
    pub(crate) key: Spanned<&'a str>,
    pub(crate) value: Spanned<&'a str>,
}

/// What the scanner makes of a text.
pub(crate) struct Scan<'a> {
    /// Sections in file order, duplicates and all.
    pub(crate) sections: Vec<RawSection<'a>>,
    /// What was left out, or amended.
    pub(crate) diagnostics: Vec<Finding>,
}

/// One line, and where it is.
pub(crate) struct Line<'a> {
    pub(crate) text: &'a str,
    start: usize,
    pub(crate) number: u32,
}

impl<'a> Line<'a> {
    /// The span of `part`, which is a piece of this line.
    pub(crate) fn span(&self, part: &str) -> Span {
        let within = part.as_ptr() as usize - self.text.as_ptr() as usize;
        let before = &self.text[..within];
        let column = match before.is_ascii() {
            true => before.len(),
            false => before.chars().count(),
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

/// The lines of a text; `\n`, `\r\n` and `\r` end one.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut rest = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let mut number = 0;
    core::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let start = text.len() - rest.len();
        let (line, behind) = match rest.find(['\n', '\r']) {
            Some(at) => {
                let end = match rest[at..].starts_with("\r\n") {
                    true => at + 2,
                    false => at + 1,
                };
                (&rest[..at], &rest[end..])
            }
            None => (rest, ""),
        };
        rest = behind;
        number += 1;
        Some(Line {
            text: line,
            start,
            number,
        })
    })
}

/// Scans a text; a byte order mark before it is skipped.
pub(crate) fn scan(text: &str) -> Scan<'_> {
    let mut scan = Scan {
        sections: Vec::new(),
        diagnostics: Vec::new(),
    };
    for line in lines(text) {
        scan.line(&line);
    }
    scan
}

impl<'a> Scan<'a> {
    fn line(&mut self, line: &Line<'a>) {
        let trimmed = line.text.trim();
        match trimmed.as_bytes().first() {
            None => {}
            Some(b';' | b'#') => self.comment(line, trimmed),
            Some(b'[') => self.header(line, trimmed),
            Some(_) => self.pair(line, trimmed),
        }
    }

    /// A comment: nothing, unless it is the one that says where a value is stored.
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
            section.storage = Some(line.spanned(value.trim()));
        }
    }

    fn header(&mut self, line: &Line<'a>, trimmed: &'a str) {
        let inside = &trimmed[1..];
        let (name, behind) = match inside.split_once(']') {
            Some((name, behind)) => (name.trim(), behind.trim()),
            None => {
                let name = inside.split([';', '#']).next().unwrap_or(inside).trim();
                self.diagnostics.push(
                    rules::W0103
                        .told(
                            line.span(trimmed),
                            format!("the section `{name}` has no closing bracket"),
                        )
                        .with_help(format!("write `[{name}]`"))
                        .fix(Fix::safe().replace(line.span(name), format!("{name}]"))),
                );
                (name, "")
            }
        };
        if !behind.is_empty() {
            self.diagnostics.push(
                rules::W0104
                    .told(
                        line.span(behind),
                        format!("`{behind}` stands behind the section `[{name}]`"),
                    )
                    .with_help("give a comment a line of its own that begins with `;`")
                    .fix(Fix::safe().replace(
                        line.span(behind),
                        format!("\n;{}", behind.trim_start_matches([';', '#'])),
                    )),
            );
        }
        if name.is_empty() {
            self.diagnostics.push(
                rules::W0110
                    .told(line.span(trimmed), "the section has no name")
                    .with_help("write the name between the brackets"),
            );
        }
        let whole = &trimmed[..trimmed.len() - behind.len()];
        self.sections.push(RawSection {
            name: line.spanned(name),
            header: line.span(whole.trim_end()),
            pairs: Vec::new(),
            storage: None,
        });
    }

    fn pair(&mut self, line: &Line<'a>, trimmed: &'a str) {
        let Some(at) = trimmed.find(['=', ':']) else {
            self.diagnostics.push(
                rules::W0101
                    .told(
                        line.span(trimmed),
                        format!("`{trimmed}` is no section, no `key=value` and no comment"),
                    )
                    .with_help("the line is ignored; begin it with `;` to make it a comment")
                    .fix(Fix::safe().replace(line.span(&trimmed[..0]), ";")),
            );
            return;
        };
        let (key, value) = (trimmed[..at].trim_end(), trimmed[at + 1..].trim_start());
        if key.is_empty() {
            self.diagnostics.push(
                rules::W0102
                    .told(
                        line.span(trimmed),
                        format!("`{trimmed}` has no key before the `=`"),
                    )
                    .with_help("the line is ignored; remove it, or name the key")
                    .fix(Fix::safe().replace(line.span(&trimmed[..0]), ";")),
            );
            return;
        }
        if trimmed[at..].starts_with(':') {
            self.diagnostics.push(
                rules::W0108
                    .told(
                        line.span(&trimmed[at..=at]),
                        format!("`{key}` is separated from its value by `:`"),
                    )
                    .with_help(format!("write `{key}={value}`"))
                    .fix(Fix::safe().replace(line.span(&trimmed[at..=at]), "=")),
            );
        }
        let pair = RawPair {
            key: line.spanned(key),
            value: line.spanned(value),
        };
        match self.sections.last_mut() {
            Some(section) => section.pairs.push(pair),
            None => {
                self.diagnostics.push(
                    rules::W0105
                        .told(
                            line.span(trimmed),
                            format!("`{key}` stands before the first section"),
                        )
                        .with_help("write the section's name above it, for example `[FileInfo]`"),
                );
                self.sections.push(RawSection {
                    name: Spanned::new("", line.span(&trimmed[..0])),
                    header: line.span(&trimmed[..0]),
                    pairs: alloc::vec![pair],
                    storage: None,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every key and value is where its span says.
    #[track_caller]
    fn check(text: &str, expected: &[(&str, &[(&str, &str)])]) -> Vec<&'static str> {
        let scan = scan(text);
        let found: Vec<_> = scan
            .sections
            .iter()
            .map(|s| {
                let pairs: Vec<_> = s.pairs.iter().map(|p| (*p.key, *p.value)).collect();
                (*s.name, pairs)
            })
            .collect();
        let expected: Vec<_> = expected.iter().map(|(n, p)| (*n, p.to_vec())).collect();
        assert_eq!(found, expected);
        for section in &scan.sections {
            for part in core::iter::once(&section.name)
                .chain(section.pairs.iter().flat_map(|p| [&p.key, &p.value]))
            {
                let Span { start, end, .. } = part.span;
                assert_eq!(&text[start as usize..end as usize], **part);
            }
        }
        scan.diagnostics.iter().map(|d| d.code()).collect()
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
    fn what_it_does_not_know_it_names() {
        let faults = check(
            "a=1\n[x\nfoo\n=3\n[y] # more\nb:2\nk=v\\\n[z\\]\nq\\=1",
            &[
                ("", &[("a", "1")]),
                ("x", &[]),
                ("y", &[("b", "2"), ("k", "v\\")]),
                ("z\\", &[("q\\", "1")]),
            ],
        );
        assert_eq!(
            faults,
            ["W0105", "W0103", "W0101", "W0102", "W0104", "W0108"]
        );
    }

    #[test]
    fn columns_count_characters() {
        let text = "[a]\nGröße = µ\r[b]";
        let scan = scan(text);
        let value = &scan.sections[0].pairs[0].value;
        assert_eq!((value.span.line, value.span.column), (2, 9));
        assert_eq!(scan.sections[1].header.line, 3);
    }

    #[test]
    fn the_storage_comment_belongs_to_its_section() {
        let scan =
            scan("; StorageLocation=X\n[a]\n;StorageLocation = RAM\n;StorageLocation=ROM\n[b]");
        assert_eq!(scan.sections[0].storage, Some(Spanned::from("RAM")));
        assert_eq!(scan.sections[1].storage, None);
    }
}
