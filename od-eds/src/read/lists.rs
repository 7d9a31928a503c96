//! The three lists of objects, against the sections.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::names::List;
use crate::scan::number::number;
use crate::scan::placed::Placed;
use crate::span::{Span, Spanned};
use od_model::Address;

/// Compares the lists of a file with the objects it has, and those that CompactPDO made.
pub(crate) fn check(
    lists: &BTreeMap<List, Vec<Placed<'_>>>,
    description: &Description,
    made: &BTreeMap<u16, ObjectDescription>,
    log: &mut Vec<Finding>,
) {
    let mut listed: BTreeMap<u16, Span> = BTreeMap::new();
    for (list, sections) in lists {
        for section in sections {
            entries(*list, section, description, made, &mut listed, log);
        }
    }
    if description.objects.is_empty() {
        return;
    }
    if listed.is_empty() {
        log.push(rules::W0203.told(Span::default(), "no object is listed").with_help(
            "list the objects in [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]",
        ));
        return;
    }
    for (index, object) in &description.objects {
        if !listed.contains_key(index) {
            let list = List::of(*index).name();
            log.push(
                rules::W0202
                    .told(object.span, format!("{index:04X}h is in no list"))
                    .about(Address::new(*index, 0))
                    .with_help(format!("add `0x{index:04X}` to [{list}]")),
            );
        }
    }
}

fn entries(
    list: List,
    placed: &Placed<'_>,
    description: &Description,
    made: &BTreeMap<u16, ObjectDescription>,
    listed: &mut BTreeMap<u16, Span>,
    log: &mut Vec<Finding>,
) {
    let mut count: Option<&Spanned<_>> = None;
    let mut found = 0;
    let mut numbers: BTreeMap<Option<i128>, Span> = BTreeMap::new();
    let mut ordered = true;
    for (key, value) in &placed.pairs {
        let word = key.bytes().filter(|b| !b.is_ascii_whitespace());
        if word
            .map(|b| b.to_ascii_lowercase())
            .eq(*b"supportedobjects")
        {
            count = count.or(Some(value));
            continue;
        }
        let Some(index) = index(key, value, description) else {
            log.push(
                rules::W0205
                    .told(
                        key.span,
                        format!("`{}={}` lists no object", key.value, value.value),
                    )
                    .with_help("write a number and an index, for example `1=0x1000`"),
            );
            continue;
        };
        found += 1;
        if let Some(first) = numbers.get(&number(key)) {
            ordered = false;
            log.push(
                rules::W0214
                    .told(key.span, format!("the number {} stands twice", key.value))
                    .with_label(*first, "it stands here")
                    .with_help("number the entries from 1 without gaps")
                    .fix(renumbered(placed)),
            );
        } else {
            numbers.insert(number(key), key.span);
        }
        if number(key) != Some(found) && ordered {
            ordered = false;
            log.push(
                rules::W0242
                    .told(
                        key.span,
                        format!(
                            "this is entry {found} of the list, and has number {}",
                            key.value
                        ),
                    )
                    .with_help("number the entries 1, 2, 3 and so on")
                    .fix(renumbered(placed)),
            );
        }
        let address = Address::new(index, 0);
        if let Some(first) = listed.get(&index) {
            log.push(
                rules::W0207
                    .told(value.span, format!("{index:04X}h is listed twice"))
                    .about(address)
                    .with_label(*first, "it is listed here")
                    .with_help("remove one of the entries")
                    .fix(Fix::safe().remove_line(value.span)),
            );
            continue;
        }
        listed.insert(index, value.span);
        if !description.objects.contains_key(&index) && !made.contains_key(&index) {
            log.push(
                rules::W0201
                    .told(
                        value.span,
                        format!("{index:04X}h is listed, but there is no section [{index:04X}]"),
                    )
                    .about(address)
                    .with_help("write the section, or remove the entry")
                    .fix(Fix::unsafe_fix().remove_line(value.span)),
            );
        }
        let right = List::of(index);
        if right != list {
            let (right, wrong) = (right.name(), list.name());
            log.push(
                rules::W0206
                    .told(
                        value.span,
                        format!("{index:04X}h belongs to [{right}], not to [{wrong}]"),
                    )
                    .about(address)
                    .with_help(format!("move the entry to [{right}]")),
            );
        }
    }
    let given = count.and_then(|count| number(count));
    if given != Some(found) && (found > 0 || count.is_some()) {
        let span = count.map_or(placed.header, |count| count.span);
        log.push(
            rules::W0204
                .told(
                    span,
                    match count {
                        Some(count) => format!(
                            "SupportedObjects is {}, but the list has {found} entries",
                            count.value
                        ),
                        None => "there is no SupportedObjects".to_string(),
                    },
                )
                .with_help(format!("write `SupportedObjects={found}`"))
                .fix(match count {
                    Some(count) => Fix::safe().replace(count.span, found.to_string()),
                    None => Fix::safe().below(placed.header, format!("SupportedObjects={found}")),
                }),
        );
    }
}

/// The index of a list entry; one without `0x` is decimal, unless only hexadecimal makes sense.
/// Every entry with the number of its place.
fn renumbered(placed: &Placed<'_>) -> Fix {
    let entries = placed.pairs.iter();
    let entries = entries.filter(|(key, _)| number(key).is_some());
    (1i128..)
        .zip(entries)
        .fold(Fix::safe(), |fix, (place, (key, _))| {
            match number(key) == Some(place) {
                true => fix,
                false => fix.replace(key.span, place.to_string()),
            }
        })
}

fn index(key: &str, value: &str, description: &Description) -> Option<u16> {
    number(key)?;
    let read = number(value).and_then(|n| u16::try_from(n).ok());
    let text = value.split([';', '#']).next().unwrap_or(value).trim();
    let exists = |index: &u16| description.objects.contains_key(index);
    if read.as_ref().is_some_and(exists) {
        return read;
    }
    let hex = u16::from_str_radix(text, 16).ok();
    hex.filter(exists).or(read)
}
