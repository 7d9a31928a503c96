//! The sections that describe no object, in a form that every tool reads.
//!
//! python-canopen needs all seven dummies, as many comment lines as the file announces, and numbers
//! where numbers belong. Lely's checker needs the spelling `DeviceComissioning`. CANopenEditor
//! needs the standard's capitals and dates, and `[FileInfo]` and `[DeviceInfo]`.

use alloc::borrow::Cow;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::Visible;

use crate::description::{Description, ObjectDescription, Section};
use crate::load;
use crate::scan::forms;
use crate::scan::forms::{Form, SectionForm};
use crate::scan::number;
use crate::span::Spanned;
use crate::write::describe::section;
use crate::write::eds;

/// The text of a description in a form that other tools read: [`complete`] and
/// [`write`](crate::write()). Control characters in names and texts are escaped.
pub fn canonical(description: &Description) -> String {
    // As `write(&complete(description))`, without a copy of all objects.
    let written = |description: &Description| {
        let sections: Vec<Section> = completed(description).collect();
        eds::text(&sections, &description.objects, counted)
    };
    let text = written(description);
    match Visible(&text).lines() {
        Cow::Borrowed(_) => text,
        // Escaped names have another order among the keys.
        Cow::Owned(visible) => written(&load::parse(&visible).description),
    }
}

/// Adds everything to a description that a generated file needs, in a form that every tool reads.
///
/// This is: the standard's capitals and order, no octal numbers, all dummies, `[FileInfo]` and
/// `[DeviceInfo]`, the numbers in SubNumber and in Comments. Sections and keys of other tools stay,
/// and so does the content of the objects.
pub fn complete(description: &Description) -> Description {
    let mut complete = Description {
        sections: completed(description).collect(),
        objects: description.objects.clone(),
    };
    for object in complete.objects.values_mut() {
        object.sub_number = counted(object);
    }
    complete
}

/// The sections that describe no object, those that every file has included.
fn completed(description: &Description) -> impl Iterator<Item = Section> {
    let made = sections(description).into_iter();
    made.map(|made| section(&made.name, made.pairs))
}

/// SubNumber: the number of sub-objects.
fn counted(object: &ObjectDescription) -> Option<Spanned<u32>> {
    let count = object.entries.len() as u32;
    object.code.has_members().then(|| Spanned::from(count))
}

/// A section to write: its name, and its keys with their values.
struct Canonical {
    name: String,
    pairs: Vec<(String, String)>,
}

/// The sections of a description, with those that every file needs.
fn sections(description: &Description) -> Vec<Canonical> {
    let mut made: Vec<(usize, Canonical)> = Vec::new();
    // Position of each section, and its keys in lower case.
    let mut places: BTreeMap<String, (usize, BTreeSet<String>)> = BTreeMap::new();
    for section in &description.sections {
        let (order, name) = name(section);
        let place = places.entry(name.to_ascii_lowercase());
        let (at, keys) = place.or_insert_with(|| {
            let pairs = Vec::new();
            made.push((order, Canonical { name, pairs }));
            (made.len() - 1, BTreeSet::new())
        });
        take(&mut made[*at].1, keys, section);
    }
    for name in ["FileInfo", "DeviceInfo", "DummyUsage"] {
        if !made.iter().any(|(_, made)| made.name == name) {
            let order = forms::section(name).map_or(0, |(order, _)| order);
            let (name, pairs) = (name.to_string(), Vec::new());
            made.push((order, Canonical { name, pairs }));
        }
    }
    // The sort is stable: unknown sections keep their order, after all others.
    made.sort_by_key(|(order, _)| *order);
    let mut made: Vec<Canonical> = made.into_iter().map(|(_, made)| made).collect();
    for section in &mut made {
        fill(section, description);
    }
    made
}

fn name(section: &Section) -> (usize, String) {
    match forms::section(&section.name) {
        Some((_, known)) if known.name == "DeviceCommissioning" => {
            let name = "DeviceComissioning";
            let order = forms::section(name).map_or(0, |(order, _)| order);
            (order, name.into())
        }
        Some((order, known)) if !known.name.contains('#') => (order, known.name.into()),
        _ => (usize::MAX, section.name.value.clone()),
    }
}

/// Adds the keys that the section does not have yet.
fn take(made: &mut Canonical, keys: &mut BTreeSet<String>, section: &Section) {
    let known = forms::section(&made.name).map(|(_, known)| known);
    for (key, value) in &section.pairs {
        let (key, value) = match known.and_then(|known| pair(known, key, value)) {
            Some(Some(canonical)) => canonical,
            Some(None) => continue,
            None => (key.value.clone(), value.value.clone()),
        };
        if keys.insert(key.to_ascii_lowercase()) {
            made.pairs.push((key, value));
        }
    }
}

/// A known key with its value; `Some(None)` if the value has no content.
fn pair(known: &SectionForm, key: &str, value: &str) -> Option<Option<(String, String)>> {
    let (name, form) = forms::key(known, key)?;
    let name = match name.split_once('#') {
        // The number in the key, with capitals if it is hexadecimal.
        Some((before, _)) => format!("{before}{}", key[before.len()..].to_ascii_uppercase()),
        None => name.into(),
    };
    let text = match form {
        Form::Text => return Some(Some((name, value.into()))),
        Form::Date => forms::date(value),
        Form::Time => forms::time(value),
        Form::Version => number::before_comment(value).into(),
        Form::Flag | Form::Number(_) => numeric(value, form),
    };
    Some((!text.is_empty()).then_some((name, text)))
}

fn numeric(value: &str, form: Form) -> String {
    let text = number::before_comment(value);
    let Some(read) = number::integer(text, &mut Vec::new()) else {
        return value.into();
    };
    match form {
        Form::Number(u32::MAX) if read.value >= 0 => format!("0x{:08X}", read.value),
        _ => read.value.to_string(),
    }
}

/// Adds the keys that every file has, and corrects numbers of entries.
fn fill(section: &mut Canonical, description: &Description) {
    let pairs = &mut section.pairs;
    let lacks = |pairs: &[(String, String)], key: &str| !pairs.iter().any(|(k, _)| k == key);
    match section.name.as_str() {
        "FileInfo" if lacks(pairs, "EDSVersion") => {
            pairs.push(("EDSVersion".into(), "4.0".into()));
        }
        "DeviceInfo" => {
            for (key, first) in [("NrOfRXPDO", 0x1400), ("NrOfTXPDO", 0x1800)] {
                if lacks(pairs, key) {
                    let count = description.objects.range(first..first + 0x200).count();
                    pairs.push((key.into(), count.to_string()));
                }
            }
            // The objects of CompactPDO have sections now.
            for (_, value) in pairs.iter_mut().filter(|(key, _)| key == "CompactPDO") {
                *value = "0".into();
            }
        }
        "DummyUsage" => {
            for dummy in 1..=7 {
                let key = format!("Dummy{dummy:04}");
                if lacks(pairs, &key) {
                    pairs.push((key, "0".into()));
                }
            }
            pairs.sort();
        }
        "Comments" => {
            let lines = core::mem::take(pairs).into_iter();
            let lines = lines.filter(|(key, _)| key != "Lines");
            let lines: Vec<_> = (1..)
                .zip(lines)
                .map(|(number, (_, text))| (format!("Line{number}"), text))
                .collect();
            pairs.push(("Lines".into(), lines.len().to_string()));
            pairs.extend(lines);
        }
        _ => {}
    }
}
