//! Gives an object another index: in its sections, its list entries, and the PDOs that map it.

use std::ops::Range;

use od_eds::outline::{self, List, Place};

use crate::file::{File, Seen};
use crate::layout::{Section, Spot};
use crate::mentions::{self, Mention, What, listed, number, plain};
use crate::types::{Position, TextEdit};
use crate::words;
use crate::xdd;

/// The mention of an object at a place.
fn mention(file: &File, seen: &Seen, offset: usize) -> Option<Mention> {
    let text = file.str();
    if let Some((element, _)) = xdd::at(&seen.elements, offset) {
        let holds = |found: &Mention| (found.bytes.start..=found.bytes.end).contains(&offset);
        return mentions::of_element(text, element).find(holds);
    }
    match seen.layout.spot(offset)? {
        Spot::Header(section) => mentions::header(text, section),
        Spot::Value(section, pair) => mentions::value(text, section, pair),
        Spot::Key(..) => None,
    }
}

/// The index at a place and its text; `None` if no object can be renamed there.
pub(crate) fn prepare(file: &File, seen: &Seen, offset: usize) -> Option<(Range<usize>, String)> {
    let found = mention(file, seen, offset)?;
    let bytes = found.index.unwrap_or(found.bytes);
    Some((bytes, format!("{:04X}", found.object.index)))
}

/// The index of the object at a place, and the new one.
///
/// # Errors
/// Reason why a rename is not possible.
pub(crate) fn indices(
    file: &File,
    seen: &Seen,
    position: Position,
    name: &str,
) -> Result<(u16, u16), String> {
    let found = mention(file, seen, file.text.offset(position));
    let old = found.ok_or("place the cursor on the index of an object")?;
    let new = index(name).ok_or_else(|| {
        format!("`{name}` is not an index; write four hexadecimal digits, such as `2001`")
    })?;
    Ok((old.object.index, new))
}

/// The edits of a file that give an object another index.
///
/// # Errors
/// The file has an object with the new index.
pub(crate) fn edits(file: &File, seen: &Seen, old: u16, new: u16) -> Result<Vec<TextEdit>, String> {
    if new == old {
        return Ok(Vec::new());
    }
    let text = file.str();
    let headers = seen.layout.sections.iter();
    let mut headers = headers.filter_map(|section| mentions::header(text, section));
    if headers.any(|header| header.object.index == new)
        || seen.description.objects.contains_key(&new)
    {
        let at = od_model::Address::new(new, 0);
        let named = words::name(&seen.description, at).unwrap_or_default();
        return Err(format!("object {new:04X}h {named:?} already exists"));
    }
    let mut moved = moved(file, seen, old, new);
    if !seen.elements.is_empty() {
        moved.extend(counts(file, old, new));
    }
    let own = mentions::all(file, seen).filter(|mention| mention.object.index == old);
    let own = own.filter(|mention| {
        mention.what != What::Entry || moved.is_empty() || !is_of_list(seen, mention)
    });
    let mut edits: Vec<(Range<usize>, String)> =
        own.map(|mention| written(file, mention, new)).collect();
    edits.extend(moved);
    edits.sort_by_key(|(bytes, _)| bytes.start);
    Ok(edits
        .into_iter()
        .map(|(bytes, new_text)| TextEdit {
            range: file.text.range(bytes),
            new_text,
        })
        .collect())
}

/// `2001`, `0x2001` or `2001h`.
fn index(name: &str) -> Option<u16> {
    let name = name.trim();
    let name = name.trim_start_matches('[').trim_end_matches(']');
    let digits = name.strip_prefix("0x").or_else(|| name.strip_prefix("0X"));
    let digits = digits.unwrap_or(name).trim_end_matches(['h', 'H']);
    if digits.is_empty() || digits.len() > 4 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    u16::from_str_radix(digits, 16)
        .ok()
        .filter(|index| *index != 0)
}

/// A mention with another index, in the same spelling if the index has digits of its own.
fn written(file: &File, mention: Mention, new: u16) -> (Range<usize>, String) {
    let Some(digits) = mention.index else {
        let text = match mention.what {
            What::Mapping => {
                // The sub-index and the length do not change.
                let number = outline::number(file.part(mention.bytes.clone())).unwrap_or_default();
                format!("0x{new:04X}{:04X}", number & 0xFFFF)
            }
            What::Header | What::Entry => format!("0x{new:04X}"),
        };
        return (mention.bytes, text);
    };
    let own = file.part(digits.clone());
    let is_lower = own.bytes().any(|b| b.is_ascii_lowercase());
    let text = if is_lower {
        format!("{new:04x}")
    } else {
        format!("{new:04X}")
    };
    (digits, text)
}

/// The counts of the object list of an XDD, for an object that moves from one of its kinds to another.
fn counts(file: &File, old: u16, new: u16) -> Vec<(Range<usize>, String)> {
    let text = file.str();
    let (from, to) = (List::of(old), List::of(new));
    let start = text.find("<CANopenObjectList").filter(|_| from != to);
    let tag = start.and_then(|start| Some(start..start + text[start..].find('>')? + 1));
    let count = |list: List, change: i64| {
        // `[OptionalObjects]` is the attribute optionalObjects.
        let bytes = xdd::attribute(text, tag.as_ref()?, list.name())?;
        let number: i64 = text.get(bytes.clone())?.trim().parse().ok()?;
        Some((bytes, (number + change).max(0).to_string()))
    };
    [count(from, -1), count(to, 1)]
        .into_iter()
        .flatten()
        .collect()
}

fn is_of_list(seen: &Seen, mention: &Mention) -> bool {
    let section = seen.layout.section_at(mention.bytes.start);
    section.is_some_and(|section| matches!(section.place, Place::List(_)))
}

/// The edits that move an entry to the list of the new index; none if it stays in its list, or
/// the list is missing.
fn moved(file: &File, seen: &Seen, old: u16, new: u16) -> Vec<(Range<usize>, String)> {
    let mut edits = Vec::new();
    let (from, to) = (List::of(old), List::of(new));
    if from == to {
        return edits;
    }
    let section = |list| seen.layout.section_of(Place::List(list));
    let (Some(from), Some(to)) = (section(from), section(to)) else {
        return edits;
    };
    let is_there = from
        .pairs
        .iter()
        .any(|pair| listed(file.str(), from, pair) == Some(old));
    if is_there {
        unlist(file, from, old, &mut edits);
        list(file, to, new, &mut edits);
    }
    edits
}

/// Removes an entry; later ones get new numbers.
fn unlist(file: &File, section: &Section, index: u16, edits: &mut Vec<(Range<usize>, String)>) {
    let text = file.str();
    let mut removed = 0;
    let mut count = 0;
    for pair in &section.pairs {
        let Some(own) = listed(text, section, pair) else {
            continue;
        };
        if own == index {
            removed += 1;
            let line = file.text.line_at(pair.key.start);
            edits.push((
                file.text.line(line).start..file.text.line(line + 1).start,
                String::new(),
            ));
            continue;
        }
        count += 1;
        let number = outline::number(file.part(pair.key.clone()));
        if let Some(number) = number.filter(|_| removed > 0) {
            edits.push((pair.key.clone(), (number - removed).to_string()));
        }
    }
    counted(file, section, count, edits);
}

/// Adds an entry at the end.
fn list(file: &File, section: &Section, index: u16, edits: &mut Vec<(Range<usize>, String)>) {
    let text = file.str();
    let entries = section
        .pairs
        .iter()
        .filter(|pair| listed(text, section, pair).is_some());
    let numbers = entries.filter_map(|pair| outline::number(file.part(pair.key.clone())));
    let (count, last) = numbers.fold((0, 0), |(count, last), number| {
        (count + 1, last.max(number))
    });
    let line = file.text.line(file.text.line_at(section.end()));
    let line_end = match text.get(line.end..) {
        Some(rest) if rest.starts_with("\r\n") => "\r\n",
        Some(rest) if rest.starts_with('\r') => "\r",
        _ => "\n",
    };
    edits.push((
        line.end..line.end,
        format!("{line_end}{}=0x{index:04X}", last + 1),
    ));
    counted(file, section, count + 1, edits);
}

/// The correct value of SupportedObjects, in the number base of the file.
fn counted(file: &File, section: &Section, count: usize, edits: &mut Vec<(Range<usize>, String)>) {
    let Some(pair) = section.get(file.str(), "SupportedObjects") else {
        return;
    };
    let bytes = plain(file.str(), pair);
    let is_hex = file
        .part(bytes.clone())
        .to_ascii_lowercase()
        .starts_with("0x");
    if number(file.str(), pair) != Some(count as i128) {
        let text = if is_hex {
            format!("0x{count:X}")
        } else {
            count.to_string()
        };
        edits.push((bytes, text));
    }
}
