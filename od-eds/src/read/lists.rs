//! The three lists of objects, against the sections.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::description::{Description, ObjectDescription};
use crate::fix::Fix;
use crate::log::Log;
use crate::rules::lists::{w0201, w0202, w0203, w0204, w0205, w0206, w0207, w0214, w0242};
use crate::scan::names::List;
use crate::scan::number::number;
use crate::scan::placed::{Placed, Text};
use crate::span::Span;

/// Compares the lists of a file with the objects it has, and those that CompactPDO made.
pub(crate) fn check(
    lists: &BTreeMap<List, Vec<Placed<'_>>>,
    description: &Description,
    made: &BTreeMap<u16, ObjectDescription>,
    log: &mut Log,
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
        log.push(w0203::finding());
        return;
    }
    for (index, object) in &description.objects {
        if !listed.contains_key(index) {
            log.push(w0202::finding(object.span, *index));
        }
    }
}

fn entries(
    list: List,
    placed: &Placed<'_>,
    description: &Description,
    made: &BTreeMap<u16, ObjectDescription>,
    listed: &mut BTreeMap<u16, Span>,
    log: &mut Log,
) {
    let mut count: Option<&Text<'_>> = None;
    let mut found = 0;
    let mut numbers: BTreeMap<Option<i128>, Span> = BTreeMap::new();
    let mut ordered = true;
    // Each of these fixes numbers all entries: more of them are of no use to anybody.
    let mut fixes = 0..8;
    let mut renumbered = || match fixes.next() {
        Some(_) => w0242::renumbered(placed),
        None => Fix::safe(),
    };
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
            log.push(w0205::finding(key, value));
            continue;
        };
        found += 1;
        if let Some(first) = numbers.get(&number(key)) {
            ordered = false;
            log.push(w0214::finding(renumbered(), key, *first));
        } else {
            numbers.insert(number(key), key.span);
        }
        if number(key) != Some(found) && ordered {
            ordered = false;
            log.push(w0242::finding(renumbered(), key, found));
        }
        if let Some(first) = listed.get(&index) {
            log.push(w0207::finding(value.span, index, *first));
            continue;
        }
        listed.insert(index, value.span);
        if !description.objects.contains_key(&index) && !made.contains_key(&index) {
            log.push(w0201::finding(value.span, index));
        }
        if List::of(index) != list {
            log.push(w0206::finding(value.span, index, list));
        }
    }
    let given = count.and_then(|count| number(count));
    if given != Some(found) && (found > 0 || count.is_some()) {
        log.push(w0204::finding(placed.header, count, found));
    }
}

/// The index of a list entry; one without `0x` is decimal, unless only hexadecimal makes sense.
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
