//! Compares the three lists of objects with the sections.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use crate::description::{Description, ObjectDescription};
use crate::fix::Fix;
use crate::log::Log;
use crate::rules::lists::reader::{
    w0201_section_missing, w0202_listed, w0202_object_not_listed, w0203_lists_missing,
    w0204_supported_objects_count, w0205_list_entry_not_valid, w0206_wrong_list,
    w0207_listed_twice, w0214_number_twice, w0218_index, w0218_number, w0242_list_numbering,
    w0242_renumbered,
};
use crate::rules::text::w0109_comment_after_other;
use crate::scan::names::List;
use crate::scan::number::{before_comment, number};
use crate::scan::section::{Text, TextSection};
use crate::span::Span;

/// The lists of a file, its objects, and those that CompactPDO added.
#[derive(Clone, Copy)]
struct File<'a> {
    lists: &'a BTreeMap<List, Vec<TextSection<'a>>>,
    description: &'a Description,
    made: &'a BTreeMap<u16, ObjectDescription>,
}

/// Compares the lists of a file with its objects, and with those that CompactPDO added.
pub(crate) fn check(
    lists: &BTreeMap<List, Vec<TextSection<'_>>>,
    description: &Description,
    made: &BTreeMap<u16, ObjectDescription>,
    log: &mut Log,
) {
    let mut listed: BTreeMap<u16, Span> = BTreeMap::new();
    let unlisted = unlisted(lists, description);
    let file = File {
        lists,
        description,
        made,
    };
    for (list, sections) in lists {
        let missing = unlisted.get(list).map_or(0, Vec::len);
        for section in sections {
            entries(*list, section, &file, missing, &mut listed, log);
        }
    }
    if description.objects.is_empty() {
        return;
    }
    if listed.is_empty() {
        log.push(w0203_lists_missing());
        return;
    }
    for (list, missing) in unlisted {
        let section = lists.get(&list).and_then(|sections| sections.first());
        // Each of these fixes adds all objects, so a few of them are enough.
        for (at, index) in missing.iter().enumerate() {
            let fix = match section {
                Some(section) if at < 8 => w0202_listed(section, &missing),
                _ => Fix::unsafe_fix(),
            };
            let span = description.objects.get(index).map(|object| object.span);
            log.push(w0202_object_not_listed(
                span.unwrap_or_default(),
                *index,
                fix,
            ));
        }
    }
}

/// The objects that no list names, by the list that should.
fn unlisted(
    lists: &BTreeMap<List, Vec<TextSection<'_>>>,
    description: &Description,
) -> BTreeMap<List, Vec<u16>> {
    let pairs = lists.values().flatten().flat_map(|section| &section.pairs);
    let entries = pairs.filter(|(key, _)| number(key).is_some());
    let listed = entries.filter_map(|(_, value)| index(value, description));
    let listed: BTreeSet<u16> = listed.collect();
    let mut unlisted: BTreeMap<List, Vec<u16>> = BTreeMap::new();
    for index in description.objects.keys() {
        if !listed.contains(index) {
            unlisted.entry(List::of(*index)).or_default().push(*index);
        }
    }
    unlisted
}

/// Compares the entries of a list with the objects, of which the lists lack `missing`.
fn entries(
    list: List,
    placed: &TextSection<'_>,
    file: &File<'_>,
    missing: usize,
    listed: &mut BTreeMap<u16, Span>,
    log: &mut Log,
) {
    let File {
        lists,
        description,
        made,
    } = *file;
    let mut count: Option<&Text<'_>> = None;
    let (mut found, mut invalid) = (0, 0);
    let mut numbers: BTreeMap<i128, Span> = BTreeMap::new();
    let mut ordered = true;
    // Each of these fixes renumbers all entries, so one of them is enough; the fix of an object
    // that is listed twice goes first. Numbers that are missing belong to objects that are, if SupportedObjects counts them.
    let all = placed.pairs.iter().filter(|(key, _)| number(key).is_some());
    let all = all.count() + missing;
    let counted = placed
        .get("SupportedObjects")
        .and_then(|count| number(count));
    let is_full = missing > 0 && counted == Some(all as i128);
    let mut fixes = if is_full || names_twice(placed, description, listed) {
        0..0
    } else {
        0..8
    };
    let mut renumbered = || match fixes.next() {
        Some(_) => w0242_renumbered(placed),
        None => Fix::safe(),
    };
    for (key, value) in &placed.pairs {
        let plain = before_comment(value);
        if plain.len() < value.len() && number(plain).is_some() {
            log.push(w0109_comment_after_other(key, value, plain));
        }
        let word = key.bytes().filter(|b| !b.is_ascii_whitespace());
        if word
            .map(|b| b.to_ascii_lowercase())
            .eq(*b"supportedobjects")
        {
            count = count.or(Some(value));
            continue;
        }
        let read = number(key).and_then(|given| Some((given, index(value, description)?)));
        let Some((given, index)) = read else {
            log.push(w0205_list_entry_not_valid(key, value));
            invalid += 1;
            continue;
        };
        found += 1;
        if !is_plain(value, index) {
            log.push(w0218_index(value, index));
        }
        if key.starts_with('0') && given != 0 || key.bytes().any(|b| !b.is_ascii_digit()) {
            log.push(w0218_number(key, given));
        }
        if let Some(first) = numbers.get(&given) {
            ordered = false;
            log.push(w0214_number_twice(renumbered(), key, *first));
        } else {
            numbers.insert(given, key.span);
        }
        if given != found && ordered {
            ordered = false;
            log.push(w0242_list_numbering(renumbered(), key, found));
        }
        if let Some(first) = listed.get(&index) {
            log.push(w0207_listed_twice(value.span, index, *first));
            continue;
        }
        listed.insert(index, value.span);
        if !description.objects.contains_key(&index) && !made.contains_key(&index) {
            log.push(w0201_section_missing(value.span, index));
        }
        if List::of(index) != list {
            let right = lists.get(&List::of(index));
            let listed = right.and_then(|sections| moved(sections.first()?, index, description));
            log.push(w0206_wrong_list(value.span, index, list, listed));
        }
    }
    let given = count.and_then(|count| number(count));
    // An invalid entry still counts as one.
    let counted = given == Some(found) || given == Some(found + invalid);
    if !counted && (found > 0 || count.is_some()) {
        let highest = numbers.keys().next_back().copied().unwrap_or(0);
        log.push(w0204_supported_objects_count(
            placed.header,
            count,
            found,
            highest,
            missing,
        ));
    }
}

/// The fix that adds an object to its list, without an edit if the list has the object; `None` if the list is not whole.
fn moved(to: &TextSection<'_>, object: u16, description: &Description) -> Option<Fix> {
    let entries = to.pairs.iter().filter(|(key, _)| number(key).is_some());
    let mut listed = entries.filter_map(|(_, value)| index(value, description));
    if listed.any(|listed| listed == object) {
        return Some(Fix::unsafe_fix());
    }
    Some(w0202_listed(to, &[object])).filter(|fix| !fix.edits.is_empty())
}

/// Returns whether a list names an object that it or an earlier list names, too.
fn names_twice(
    placed: &TextSection<'_>,
    description: &Description,
    listed: &BTreeMap<u16, Span>,
) -> bool {
    let mut seen = BTreeSet::new();
    let entries = placed.pairs.iter().filter(|(key, _)| number(key).is_some());
    let mut indices = entries.filter_map(|(_, value)| index(value, description));
    indices.any(|index| !seen.insert(index) || listed.contains_key(&index))
}

/// The index in a list entry, in any spelling; without `0x` it is decimal, unless only
/// hexadecimal gives an index.
fn index(value: &str, description: &Description) -> Option<u16> {
    let read = number(value).and_then(|n| u16::try_from(n).ok());
    let text = before_comment(value);
    let exists = |index: &u16| description.objects.contains_key(index);
    if read.as_ref().is_some_and(exists) {
        return read;
    }
    let bare = text.strip_prefix('$').unwrap_or(text);
    let hex = u16::from_str_radix(bare, 16).ok();
    hex.filter(exists).or(read)
}

/// Returns whether the index has a spelling of CiA 306: hexadecimal with `0x`, or decimal.
fn is_plain(value: &str, index: u16) -> bool {
    let text = before_comment(value);
    let hex = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    match hex {
        Some(digits) => u16::from_str_radix(digits, 16) == Ok(index),
        None => !text.starts_with('0') && text.parse() == Ok(index),
    }
}
