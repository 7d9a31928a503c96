//! The outline of a file: its sections, with sub-objects below their objects.

use od_eds::Description;
use od_eds::outline::{Compact, Place};
use od_model::Address;

use crate::file::File;
use crate::layout::{Layout, Section};
use crate::types::DocumentSymbol;
use crate::words;

/// Kinds of symbols.
const MODULE: u8 = 2;
const FIELD: u8 = 8;
const VARIABLE: u8 = 13;
const ARRAY: u8 = 18;
const OBJECT: u8 = 19;

/// The outline, in file order.
pub(crate) fn of(file: &File, layout: &Layout, description: &Description) -> Vec<DocumentSymbol> {
    let mut found: Vec<DocumentSymbol> = Vec::new();
    // The object of the last symbol; sub-objects are added to it.
    let mut open = None;
    for section in &layout.sections {
        let symbol = symbol(file, section, description);
        let below = matches!(section.place, Place::Member(..) | Place::Compact(..));
        match found.last_mut() {
            Some(parent) if below && open == section.index() => {
                parent.range.end = symbol.range.end;
                parent.children.push(symbol);
            }
            _ => {
                open = section.index();
                found.push(symbol);
            }
        }
    }
    found
}

fn symbol(file: &File, section: &Section, description: &Description) -> DocumentSymbol {
    let name = file.part(section.name.clone());
    let parameter = section.get(file.str(), "ParameterName");
    let own = parameter
        .map(|pair| file.part(pair.value.clone()))
        .unwrap_or_default();
    let (mut label, kind) = match section.place {
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
        Place::Other => (name.to_owned(), MODULE),
    };
    label.truncate(label.trim_end().len());
    // A symbol must have a name.
    if label.is_empty() {
        label.push_str("[]");
    }
    DocumentSymbol {
        name: label,
        detail: detail(section, description),
        kind,
        range: file.text.range(section.header.start..section.end()),
        selection_range: file.text.range(section.header.clone()),
        children: Vec::new(),
    }
}

/// Type and access of a value, or the object code of an object.
fn detail(section: &Section, description: &Description) -> String {
    let (index, sub) = match section.place {
        Place::Object(index) => (index, 0),
        Place::Member(index, sub) => (index, sub),
        _ => return String::new(),
    };
    let Some(object) = description.objects.get(&index) else {
        return String::new();
    };
    if object.code.has_members() && matches!(section.place, Place::Object(_)) {
        return object.code.name().into();
    }
    let Some(entry) = object.entries.get(&sub) else {
        return String::new();
    };
    words::of_type(entry)
}
