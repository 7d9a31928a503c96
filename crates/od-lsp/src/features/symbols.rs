//! The outline of a file: its sections, with sub-objects below their objects.

use std::ops::Range;

use od_eds::Description;
use od_eds::outline::{Compact, Place};
use od_model::Address;

use crate::file::{File, Kind, Seen};
use crate::project;
use crate::types::DocumentSymbol;
use crate::words;

/// Kinds of symbols.
const MODULE: u8 = 2;
const FIELD: u8 = 8;
const VARIABLE: u8 = 13;
const ARRAY: u8 = 18;
const OBJECT: u8 = 19;

/// A part of a file that has a symbol.
struct Part {
    place: Place,
    /// The name of the section.
    name: String,
    /// The name of the object in the file.
    own: String,
    whole: Range<usize>,
    /// The header, or the start tag of an element.
    header: Range<usize>,
}

/// The outline, in file order.
pub(crate) fn of(file: &File, seen: &Seen) -> Vec<DocumentSymbol> {
    if file.kind == Kind::Project {
        let sections = project::sections(file.str()).into_iter();
        let part = |(name, whole): (Range<usize>, Range<usize>)| Part {
            place: Place::Other,
            name: file.part(name.clone()).into(),
            own: String::new(),
            whole: name.start..whole.end.max(name.end),
            header: name,
        };
        let symbols = sections.map(|section| symbol(file, &part(section), &seen.description));
        return symbols.collect();
    }
    let mut found: Vec<DocumentSymbol> = Vec::new();
    // The object of the last symbol; sub-objects are added to it.
    let mut open = None;
    for part in parts(file, seen) {
        let symbol = symbol(file, &part, &seen.description);
        let (index, is_below) = match part.place {
            Place::Object(index) => (Some(index), false),
            Place::Member(index, _) | Place::Compact(index, _) => (Some(index), true),
            Place::List(_) | Place::Other => (None, false),
        };
        match found.last_mut() {
            Some(parent) if is_below && open == index => {
                parent.range.end = symbol.range.end;
                parent.children.push(symbol);
            }
            _ => {
                open = index;
                found.push(symbol);
            }
        }
    }
    found
}

/// The sections of an EDS, or the objects and sub-objects of an XDD.
fn parts(file: &File, seen: &Seen) -> Vec<Part> {
    let sections = seen.layout.sections.iter().map(|section| {
        let parameter = section.get(file.str(), "ParameterName");
        let own = parameter.map(|pair| file.part(pair.value.clone()));
        Part {
            place: section.place,
            name: file.part(section.name.clone()).into(),
            own: own.unwrap_or_default().into(),
            whole: section.header.start..section.end(),
            header: section.header.clone(),
        }
    });
    let elements = seen.elements.iter().filter_map(|element| {
        let objects = &seen.description.objects;
        let own = match element.place {
            Place::Object(index) => objects.get(&index).map(|object| &object.name),
            Place::Member(index, sub) => {
                let entry = objects.get(&index)?.entries.get(&sub);
                entry.map(|entry| &entry.name)
            }
            _ => return None,
        };
        Some(Part {
            place: element.place,
            name: element.name.clone(),
            own: own.map_or_else(String::new, |name| name.value.clone()),
            whole: element.tag.clone(),
            header: element.tag.clone(),
        })
    });
    sections.chain(elements).collect()
}

fn symbol(file: &File, part: &Part, description: &Description) -> DocumentSymbol {
    let own = &part.own;
    let (mut label, kind) = match part.place {
        Place::Object(index) => {
            let object = description.objects.get(&index);
            let kind = match object {
                Some(object) if object.code.has_members() => OBJECT,
                _ => VARIABLE,
            };
            (format!("{index:04X}h {own}"), kind)
        }
        Place::Member(index, sub) => (format!("{} {own}", Address::new(index, sub)), FIELD),
        Place::Compact(index, list) => {
            let list = match list {
                Compact::Name => "names",
                Compact::Value => "values",
                Compact::Denotation => "denotations",
            };
            (format!("{index:04X}h {list}"), ARRAY)
        }
        Place::List(list) => (list.name().to_owned(), ARRAY),
        Place::Other => (part.name.clone(), MODULE),
    };
    label.truncate(label.trim_end().len());
    // A symbol must have a name.
    if label.is_empty() {
        label.push_str("[]");
    }
    DocumentSymbol {
        name: label,
        detail: detail(part.place, description),
        kind,
        range: file.text.range(part.whole.clone()),
        selection_range: file.text.range(part.header.clone()),
        children: Vec::new(),
    }
}

/// Type and access of a value, or the object code of an object.
fn detail(place: Place, description: &Description) -> String {
    let (index, sub) = match place {
        Place::Object(index) => (index, 0),
        Place::Member(index, sub) => (index, sub),
        _ => return String::new(),
    };
    let Some(object) = description.objects.get(&index) else {
        return String::new();
    };
    if object.code.has_members() && matches!(place, Place::Object(_)) {
        return object.code.name().into();
    }
    let Some(entry) = object.entries.get(&sub) else {
        return String::new();
    };
    words::of_type(entry)
}
