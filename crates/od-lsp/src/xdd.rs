//! The elements of an XDD: the object of each, and the places of its fields.

use std::ops::Range;

use od_eds::outline::{self, Place, TextSection};

use crate::layout::bytes;

/// An element that describes an object, a sub-object or a part of the file, as a section of an EDS would.
pub(crate) struct Element {
    /// Its subject.
    pub(crate) place: Place,
    /// The name of the section of an EDS: `1018sub1`, `DeviceInfo`.
    pub(crate) name: String,
    /// Its start tag.
    pub(crate) tag: Range<usize>,
    pub(crate) fields: Vec<Field>,
}

/// A field of an element, or of the parameter that it refers to.
pub(crate) struct Field {
    /// The key of an EDS: `DefaultValue` for `defaultValue="7"`.
    pub(crate) key: String,
    /// The value between its quotation marks.
    pub(crate) value: Range<usize>,
}

/// The elements of the sections that the reader makes of an XDD, in file order.
pub(crate) fn elements(sections: &[TextSection<'_>]) -> Vec<Element> {
    let elements = sections.iter().map(|section| {
        let pairs = section.pairs.iter();
        // A field that the file does not write has the place of the start tag.
        let written = pairs.filter(|(_, value)| value.span != section.header);
        Element {
            place: outline::place(&section.name),
            name: section.name.to_string(),
            tag: bytes(section.header),
            fields: written
                .map(|(key, value)| Field {
                    key: key.to_string(),
                    value: bytes(value.span),
                })
                .collect(),
        }
    });
    elements.collect()
}

/// The element at a byte, with the field whose value is there.
pub(crate) fn at(elements: &[Element], offset: usize) -> Option<(&Element, Option<&Field>)> {
    let holds = |range: &Range<usize>| range.start <= offset && offset <= range.end;
    let fields = elements
        .iter()
        .flat_map(|element| element.fields.iter().map(move |field| (element, field)));
    let mut found = fields.filter(|(_, field)| holds(&field.value));
    match found.next() {
        Some((element, field)) => Some((element, Some(field))),
        None => {
            let own = elements.iter().find(|element| holds(&element.tag))?;
            Some((own, None))
        }
    }
}

/// The labels and descriptions of the parameter that an element refers to, each with its language, and the label of its unit.
pub(crate) fn texts(text: &str, element: &Element) -> Vec<(String, String)> {
    let id = attribute(text, &element.tag, "uniqueIDRef").and_then(|id| text.get(id));
    let Some(start) = id.and_then(|id| with_id(text, id)) else {
        return Vec::new();
    };
    let behind = text.get(start.end..).unwrap_or_default();
    let is_empty = text[start.clone()].ends_with("/>");
    let end = behind.find("parameter>").filter(|_| !is_empty).unwrap_or(0);
    let mut found = Vec::new();
    for (at, _) in behind[..end].match_indices('<').take(MOST) {
        let own = &behind[at..end];
        let name = own[1..]
            .split(|c: char| c.is_whitespace() || matches!(c, '>' | '/'))
            .next();
        let name = name.and_then(|name| name.rsplit(':').next());
        if !matches!(name, Some("label" | "description")) {
            continue;
        }
        let Some((tag, (content, _))) = own
            .split_once('>')
            .and_then(|(tag, rest)| Some((tag, rest.split_once('<')?)))
        else {
            continue;
        };
        let tag = start.end + at..start.end + at + tag.len();
        let lang = attribute(text, &tag, "lang").and_then(|lang| text.get(lang));
        let plain = content
            .replace("&lt;", "<")
            .replace("&gt;", ">")
            .replace("&quot;", "\"");
        let plain = plain.replace("&apos;", "'").replace("&amp;", "&");
        let words: Vec<&str> = plain.split_whitespace().collect();
        if !words.is_empty() {
            found.push((lang.unwrap_or_default().into(), words.join(" ")));
        }
    }
    found
}

/// Maximum number of elements of a parameter whose texts a hover shows.
const MOST: usize = 50;

/// The start tag at a byte.
pub(crate) struct Tag<'a> {
    /// The name of the element, without a prefix.
    pub(crate) element: &'a str,
    pub(crate) range: Range<usize>,
    pub(crate) cursor: Cursor<'a>,
}

/// The part of a start tag at a byte.
pub(crate) enum Cursor<'a> {
    /// The name of an attribute that is typed.
    Name(Range<usize>),
    /// The value of the attribute of this name.
    Value(&'a str, Range<usize>),
}

/// The start tag at a byte that is after the name of its element.
pub(crate) fn tag(text: &str, offset: usize) -> Option<Tag<'_>> {
    let start = text.get(..offset)?.rfind('<')?;
    let typed = text.get(start + 1..offset)?;
    let name = typed.split(char::is_whitespace).next()?;
    if name.len() == typed.len() || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return None;
    }
    let mut open = None;
    for (at, c) in typed.char_indices() {
        match (open, c) {
            (None, '>') => return None,
            (None, '"' | '\'') => open = Some((c, at)),
            (Some((quote, _)), _) if quote == c => open = None,
            _ => {}
        }
    }
    let behind = text.get(offset..)?;
    let rest = behind.find(['<', '>']).unwrap_or(behind.len());
    let word = |before: &str| {
        let end = before.trim_end();
        let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        end.rfind(is_other).map_or(0, |at| at + 1)..end.len()
    };
    let cursor = match open {
        Some((quote, at)) => {
            let key = typed.get(..at)?.trim_end().strip_suffix('=')?;
            let end = behind.get(..rest)?.find(quote).unwrap_or(0);
            Cursor::Value(key.get(word(key))?, start + at + 2..offset + end)
        }
        None if typed.ends_with(char::is_whitespace) => Cursor::Name(offset..offset),
        None => Cursor::Name(start + 1 + word(typed).start..offset),
    };
    Some(Tag {
        element: name.rsplit(':').next()?,
        range: start..offset + rest,
        cursor,
    })
}

/// The name of the attribute whose value a field is.
pub(crate) fn name<'a>(text: &'a str, field: &Field) -> &'a str {
    let before = text.get(..field.value.start).unwrap_or_default();
    let before = before.trim_end_matches(['"', '\'']).trim_end();
    let before = before.trim_end_matches('=').trim_end();
    let start = before.rfind(|c: char| !c.is_ascii_alphanumeric());
    before
        .get(start.map_or(0, |at| at + 1)..)
        .unwrap_or_default()
}

/// The value of an attribute between its quotation marks, in a start tag.
pub(crate) fn attribute(text: &str, tag: &Range<usize>, name: &str) -> Option<Range<usize>> {
    let own = text.get(tag.clone())?;
    let mut at = own.find(char::is_whitespace)?;
    loop {
        let key = own.get(at..)?.trim_start();
        let equals = key.find('=')?;
        let value = key.get(equals + 1..)?.trim_start();
        let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
        let start = own.len() - value.len() + 1;
        let end = start + own.get(start..)?.find(quote)?;
        if key.get(..equals)?.trim_end().eq_ignore_ascii_case(name) {
            return Some(tag.start + start..tag.start + end);
        }
        at = end + 1;
    }
}

/// The start tag of the parameter whose uniqueIDRef is at a byte.
pub(crate) fn parameter(text: &str, elements: &[Element], offset: usize) -> Option<Range<usize>> {
    let (element, _) = at(elements, offset)?;
    let given = attribute(text, &element.tag, "uniqueIDRef")?;
    if !(given.start..=given.end).contains(&offset) {
        return None;
    }
    with_id(text, text.get(given)?)
}

/// The start tag of the element with this uniqueID.
fn with_id(text: &str, id: &str) -> Option<Range<usize>> {
    text.match_indices(" uniqueID").find_map(|(at, _)| {
        let start = text[..at].rfind('<')?;
        let tag = start..start + text[start..].find('>')? + 1;
        let own = attribute(text, &tag, "uniqueID")?;
        (text.get(own)? == id).then_some(tag)
    })
}
