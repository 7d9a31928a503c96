//! Sections and keys of a document by their names.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{Document, Edit, EditError, one_line};
use crate::fact::Key;
use crate::scan::lines;
use crate::scan::number;
use crate::scan::number::Note;
use crate::scan::section::{Text, TextSection};
use crate::span::Span;

impl Document {
    /// The value of a key in the sections of a name, ignoring case; of duplicate keys the first
    /// counts. It includes the rest of its line if that is a comment.
    pub fn get(&self, section: &str, key: &str) -> Option<&str> {
        let sections = lines::sections(&self.text);
        let (_, value) = pairs(&sections, section, key).next()?;
        let Span { start, end, .. } = value.span;
        self.text.get(start as usize..end as usize)
    }

    /// Sets the value of a key: an existing key keeps its place, a new one becomes the last of its section.
    ///
    /// Spaces around the `=` stay, and so does a comment after a number.
    ///
    /// # Errors
    ///
    /// The section is missing, or the key or the value does not fit into a line.
    pub fn set(&mut self, section: &str, key: &str, value: &str) -> Result<(), EditError> {
        let edit = self.set_edit(section, key, value)?;
        self.apply(&[edit])
    }

    /// The edit that [`set`](Self::set) makes.
    ///
    /// # Errors
    ///
    /// As for [`set`](Self::set).
    pub fn set_edit(&self, section: &str, key: &str, value: &str) -> Result<Edit, EditError> {
        one_line(key, &['=', ':'])?;
        one_line(value, &[])?;
        if key.is_empty() || key.starts_with([';', '#', '[']) {
            return Err(EditError::NotOneLine(key.to_string()));
        }
        let sections = lines::sections(&self.text);
        if let Some((key, old)) = pairs(&sections, section, key).next() {
            let before = number::before_comment(old);
            let start = old.span.start as usize;
            let len = if holds_comment(key, before) {
                before.len()
            } else {
                old.len()
            };
            return Ok(Edit {
                range: start..start + len,
                text: value.into(),
            });
        }
        let Some(found) = named(&sections, section).next() else {
            return Err(EditError::NoSection(section.into()));
        };
        let last = found.pairs.last().map_or(found.header, |(key, _)| key.span);
        Ok(self.lines_behind(last.start as usize, &[format!("{key}={value}")]))
    }

    /// Removes a key from all sections of the name; `false` if none has it.
    pub fn remove(&mut self, section: &str, key: &str) -> bool {
        let sections = lines::sections(&self.text);
        let edits: Vec<Edit> = pairs(&sections, section, key)
            .map(|(key, _)| self.without_line(key.span))
            .collect();
        !edits.is_empty() && self.apply(&edits).is_ok()
    }

    /// Adds a section at the end.
    ///
    /// # Errors
    ///
    /// A section of the name exists already, or a name, key or value does not fit into a line.
    pub fn add_section(&mut self, name: &str, pairs: &[(&str, &str)]) -> Result<(), EditError> {
        one_line(name, &['[', ']'])?;
        let sections = lines::sections(&self.text);
        if named(&sections, name).next().is_some() {
            return Err(EditError::SectionExists(name.into()));
        }
        let mut section = alloc::vec![format!("[{name}]")];
        for (key, value) in pairs {
            one_line(key, &['=', ':'])?;
            one_line(value, &[])?;
            section.push(format!("{key}={value}"));
        }
        let edit = self.section_at_end(section);
        self.apply(&[edit])
    }

    /// Removes the sections of a name with all their keys; `false` if the name is missing.
    pub fn remove_section(&mut self, name: &str) -> bool {
        let sections = lines::sections(&self.text);
        let edits: Vec<Edit> = named(&sections, name)
            .map(|section| self.without_section(section))
            .collect();
        !edits.is_empty() && self.apply(&edits).is_ok()
    }

    /// A section at the end, with a blank line before it.
    pub(super) fn section_at_end(&self, mut lines: Vec<String>) -> Edit {
        let end = self.text.len();
        let last = self.text.trim_end().len();
        if last > 0 && self.text[last..].matches(self.line_end(end)).count() < 2 {
            lines.insert(0, String::new());
        }
        // In the last line, or after it if it has a line end.
        let at = if self.text.ends_with(['\r', '\n']) {
            end
        } else {
            self.text.rfind(['\r', '\n']).map_or(0, |at| at + 1)
        };
        self.lines_behind(at, &lines)
    }

    /// The deletion of the line in which a span begins.
    pub(super) fn without_line(&self, span: Span) -> Edit {
        let at = span.start as usize;
        Edit {
            range: self.line_start(at)..self.next_line(at),
            text: String::new(),
        }
    }

    /// Deletes a section: its lines up to a blank line after its last key, and the blank lines that follow.
    pub(super) fn without_section(&self, section: &TextSection<'_>) -> Edit {
        let last = section
            .pairs
            .last()
            .map_or(section.header, |(key, _)| key.span);
        let mut end = self.next_line(last.start as usize);
        let mut blank = false;
        while end < self.text.len() {
            let next = self.next_line(end);
            let line = self.text[end..next].trim();
            blank |= line.is_empty();
            if line.starts_with('[') || (blank && !line.is_empty()) {
                break;
            }
            end = next;
        }
        Edit {
            range: self.line_start(section.header.start as usize)..end,
            text: String::new(),
        }
    }

    fn line_start(&self, at: usize) -> usize {
        self.text[..at].rfind(['\r', '\n']).map_or(0, |end| end + 1)
    }
}

/// The sections of a name, ignoring case.
pub(super) fn named<'s, 'a>(
    sections: &'s [TextSection<'a>],
    name: &'s str,
) -> impl Iterator<Item = &'s TextSection<'a>> {
    sections
        .iter()
        .filter(move |section| section.name.eq_ignore_ascii_case(name))
}

fn pairs<'s, 'a>(
    sections: &'s [TextSection<'a>],
    section: &'s str,
    key: &'s str,
) -> impl Iterator<Item = &'s (Text<'a>, Text<'a>)> {
    named(sections, section)
        .flat_map(|section| &section.pairs)
        .filter(move |(own, _)| own.eq_ignore_ascii_case(key))
}

/// Returns whether the text after the value is a comment, as it is after a number or a word of CiA 306.
fn holds_comment(key: &str, before: &str) -> bool {
    let not_text =
        |known: &Key| known.is_coded() || matches!(known, Key::LowLimit | Key::HighLimit);
    let mut known = Key::ALL.into_iter().filter(not_text);
    let mut notes = Vec::new();
    known.any(|known| known.is(key))
        || number::node_id(before, &mut notes).is_some()
        // `FF` may be a text.
        || number::integer(before, &mut notes).is_some() && !notes.contains(&Note::BareHex)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(before: &str, edit: impl Fn(&mut Document), after: &str) {
        for end in ["\n", "\r\n", "\r"] {
            let mut document = Document::new(before.replace('\n', end));
            edit(&mut document);
            assert_eq!(document.text(), after.replace('\n', end));
            assert_eq!(document.bytes(), document.text().as_bytes());
        }
    }

    #[test]
    fn a_changed_value_keeps_its_place() {
        let set = |section: &'static str, key: &'static str, value: &'static str| {
            move |document: &mut Document| document.set(section, key, value).unwrap()
        };
        check(
            "[a]\n X = 1 ;c\nY=2",
            set("A", "x", "7"),
            "[a]\n X = 7 ;c\nY=2",
        );
        check("[a]\nN=a ;b\n", set("a", "N", "c"), "[a]\nN=c\n");
        check(
            "[a]\nAccessType=rx # c\n",
            set("a", "AccessType", "rw"),
            "[a]\nAccessType=rw # c\n",
        );
        check("[a]\nX=\n", set("a", "X", "1"), "[a]\nX=1\n");
        check(
            "[a]\nX=1\n[a]\nX=2\n",
            set("a", "X", "3"),
            "[a]\nX=3\n[a]\nX=2\n",
        );
    }

    #[test]
    fn a_new_key_is_the_last_of_its_section() {
        let set = |document: &mut Document| document.set("a", "Z", "9").unwrap();
        check(
            "[a]\nX=1\n\n;of b\n[b]\n",
            set,
            "[a]\nX=1\nZ=9\n\n;of b\n[b]\n",
        );
        check("[a]\n[b]\n", set, "[a]\nZ=9\n[b]\n");
        check("[b]\n[a]\nX=1", set, "[b]\n[a]\nX=1\nZ=9");
        check("[b]\n[a]\nX=1\n", set, "[b]\n[a]\nX=1\nZ=9\n");
    }

    #[test]
    fn a_removed_part_takes_its_lines_along() {
        let key = |document: &mut Document| assert!(document.remove("A", "x"));
        check("[a]\nX=1\nY=2\nX=3\n", key, "[a]\nY=2\n");
        check("[b]\nY=2\n[a]\nX=1", key, "[b]\nY=2\n[a]\n");
        let section = |document: &mut Document| assert!(document.remove_section("a"));
        check(
            "[b]\n\n[a]\nX=1\n;of a\n\n;of c\n[c]\n",
            section,
            "[b]\n\n;of c\n[c]\n",
        );
        check("[a]\n[b]\n", section, "[b]\n");
        let mut document = Document::new(&b"[a]\n"[..]);
        assert!(!document.remove("a", "x") && !document.remove_section("b"));
    }

    #[test]
    fn a_new_section_comes_last() {
        let add = |document: &mut Document| document.add_section("N", &[("a", "1")]).unwrap();

        check("[a]\nX=1\n", add, "[a]\nX=1\n\n[N]\na=1\n");
        check("[a]\nX=1\n\n", add, "[a]\nX=1\n\n[N]\na=1\n");
        let mut document = Document::default();
        add(&mut document);
        assert_eq!(document.text(), "[N]\na=1\n");
        check("[a]\nX=1", add, "[a]\nX=1\n\n[N]\na=1");
    }

    #[test]
    fn a_text_that_does_not_fit_into_a_line_is_refused() {
        let mut document = Document::new(&b"[a]\nX=1\n"[..]);
        let before = document.clone();
        for (key, value) in [
            ("X", "1\n2"),
            ("a=b", "1"),
            (";x", "1"),
            ("", "1"),
            ("X", " 1"),
        ] {
            let error = document.set("a", key, value).unwrap_err();
            assert!(matches!(error, EditError::NotOneLine(_)), "{key}={value}");
        }
        let error = document.set("b", "X", "1").unwrap_err();
        assert_eq!(error, EditError::NoSection("b".into()));
        let error = document.add_section("A", &[]).unwrap_err();
        assert_eq!(error, EditError::SectionExists("A".into()));
        assert_eq!(document, before);
        assert_eq!(document.get("A", "x"), Some("1"));
    }
}
