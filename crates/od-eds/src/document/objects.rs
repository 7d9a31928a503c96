//! Objects of a document: their sections, and their places in the lists.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::keys::named;
use super::{Document, Edit, EditError};
use crate::description::ObjectDescription;
use crate::scan::lines;
use crate::scan::names::{List, Place, place};
use crate::scan::number;
use crate::scan::section::TextSection;
use crate::write::eds;

impl Document {
    /// Adds an object: its sections at the end, and its entry in its list.
    ///
    /// # Errors
    ///
    /// There is a section for the index, or the file's encoding lacks a character.
    pub fn add_object(&mut self, index: u16, object: &ObjectDescription) -> Result<(), EditError> {
        let sections = lines::sections(&self.text);
        if sections.iter().any(|section| is_of(section, index)) {
            return Err(EditError::SectionExists(format!("{index:04X}")));
        }
        let mut edits = Vec::new();
        let mut behind = Vec::new();
        let list = List::of(index).name();
        match named(&sections, list).next() {
            Some(section) => self.entry_edits(section, index, &mut edits),
            None => {
                behind.push(format!("[{list}]"));
                behind.push("SupportedObjects=1".into());
                behind.push(format!("1=0x{index:04X}"));
                behind.push(String::new());
            }
        }
        let text = eds::object(index, object);
        behind.extend(text.lines().map(ToString::to_string));
        edits.push(self.section_at_end(behind));
        self.apply(&edits)
    }

    /// Removes an object: its sections, those of its members, and its entries in the lists, which
    /// are renumbered from there. `false` if the object does not exist.
    pub fn remove_object(&mut self, index: u16) -> bool {
        let sections = lines::sections(&self.text);
        let mut edits = Vec::new();
        for section in &sections {
            if is_of(section, index) {
                edits.push(self.without_section(section));
            } else if let Place::List(_) = place(&section.name) {
                self.unlist_edits(section, index, &mut edits);
            }
        }
        !edits.is_empty() && self.apply(&edits).is_ok()
    }

    /// A new last entry of a list.
    fn entry_edits(&self, section: &TextSection<'_>, index: u16, edits: &mut Vec<Edit>) {
        let mut number = 0;
        let mut count = 0;
        let mut last = section.header;
        for (key, _) in &section.pairs {
            if let Some(n) = read(key) {
                number = number.max(n);
                count += 1;
                last = key.span;
            } else if count == 0 {
                last = key.span;
            }
        }
        let entry = format!("{}=0x{index:04X}", number.saturating_add(1));
        edits.push(self.lines_behind(last.start as usize, &[entry]));
        count_edit(section, count + 1, edits);
    }

    fn unlist_edits(&self, section: &TextSection<'_>, index: u16, edits: &mut Vec<Edit>) {
        let entries = section
            .pairs
            .iter()
            .filter_map(|(key, value)| Some((read(key)?, key, value)));
        let mut removed = 0;
        let mut count = 0;
        for (number, key, value) in entries {
            let value = number::before_comment(value);
            if read(value) == Some(i128::from(index)) {
                removed += 1;
                edits.push(self.without_line(key.span));
                continue;
            }
            count += 1;
            if removed > 0 {
                let number = (number - removed).to_string();
                edits.push(Edit::replace(key.span, number));
            }
        }
        if removed > 0 {
            count_edit(section, count, edits);
        }
    }
}

fn is_of(section: &TextSection<'_>, index: u16) -> bool {
    match place(&section.name) {
        Place::Object(of) | Place::Member(of, _) | Place::Compact(of, _) => of == index,
        Place::List(_) | Place::Other => false,
    }
}

fn read(text: &str) -> Option<i128> {
    number::integer(text, &mut Vec::new()).map(|number| number.value)
}

/// The correct SupportedObjects, in the same spelling as before.
fn count_edit(section: &TextSection<'_>, count: usize, edits: &mut Vec<Edit>) {
    let found = section
        .pairs
        .iter()
        .find(|(key, _)| key.eq_ignore_ascii_case("SupportedObjects"));
    let Some((_, given)) = found else { return };
    let value = number::before_comment(given);
    let start = given.span.start as usize;
    edits.push(Edit {
        range: start..start + value.len(),
        text: if value.starts_with("0x") || value.starts_with("0X") {
            format!("0x{count:X}")
        } else {
            count.to_string()
        },
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::EntryDescription;
    use od_model::DataType;

    const TEXT: &str = "[ManufacturerObjects]\nSupportedObjects=0x2 ; two\n1=0x2000\n2=0x2001\n\n\
        [2000]\nParameterName=A\n[2000sub0]\nDataType=5\n\n;keep\n[2001]\nParameterName=B\n";

    #[test]
    fn an_object_is_removed_with_its_members_and_its_entry() {
        let mut document = Document::new(TEXT);
        assert!(document.remove_object(0x2000));
        assert_eq!(
            document.text(),
            "[ManufacturerObjects]\nSupportedObjects=0x1 ; two\n1=0x2001\n\n\
             ;keep\n[2001]\nParameterName=B\n"
        );
        assert!(!document.remove_object(0x2000));
    }

    #[test]
    fn an_object_is_added_with_its_entry() {
        let mut document = Document::new(TEXT);
        let entry = EntryDescription::new("C", DataType::Unsigned8);
        let object = ObjectDescription::var(entry);
        document.add_object(0x2002, &object).unwrap();
        let added = "\n[2002]\nParameterName=C\nObjectType=0x7\nDataType=0x0005\nAccessType=ro\nPDOMapping=0\n";
        let expected = TEXT
            .replace("0x2 ; two", "0x3 ; two")
            .replace("2=0x2001\n", "2=0x2001\n3=0x2002\n")
            + added;
        assert_eq!(document.text(), expected);
        let error = document.add_object(0x2001, &object).unwrap_err();
        assert_eq!(error, EditError::SectionExists("2001".into()));
        document.add_object(0x6000, &object).unwrap();
        assert!(document.text().contains(
            "\n\n[OptionalObjects]\nSupportedObjects=1\n1=0x6000\n\n[6000]\nParameterName=C\n"
        ));
        assert_eq!(document.parse().description.objects.len(), 4);
    }
}
