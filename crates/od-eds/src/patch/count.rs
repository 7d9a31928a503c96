//! Updates sub-index 0 and SubNumber after a patch adds or removes members.

use alloc::collections::BTreeMap;

use super::{Action, Edit};
use crate::description::{Description, EntryDescription, ObjectDescription, Value};
use crate::span::{Span, Spanned};
use od_model::{Access, DataType};

/// The objects that get or lose members and whose sub-index 0 is updated, with the place
/// of the last edit that causes it.
pub(super) fn counted(description: &Description, edits: &[Edit]) -> BTreeMap<u16, Span> {
    let mut counted = BTreeMap::new();
    for edit in edits {
        let index = edit.target.index;
        let follows = match (edit.action, description.objects.get(&index)) {
            (Action::Modify, _) => false,
            (_, None) => true,
            (_, Some(object)) => edit.target.sub.is_some() && is_counted(object),
        };
        if follows {
            counted.insert(index, edit.target.span);
        }
    }
    for edit in edits.iter().filter(|edit| edit.target.sub == Some(0)) {
        counted.remove(&edit.target.index);
    }
    counted
}

/// The highest sub-index. FFh does not count: it describes the object.
fn highest(object: &ObjectDescription) -> Option<u8> {
    let mut counted = object.entries.keys().filter(|sub| **sub != 0xFF);
    counted.next_back().copied()
}

/// Returns whether sub-index 0 holds the highest sub-index.
fn is_counted(object: &ObjectDescription) -> bool {
    let highest = highest(object);
    let count = object
        .entries
        .get(&0)
        .and_then(|entry| entry.default.as_ref());
    match (count.map(|count| &count.value), highest) {
        (Some(Value::Unsigned(count)), Some(highest)) => *count == u64::from(highest),
        _ => false,
    }
}

/// Index of the error history. Its sub-index 0 is the number of errors, and a master clears it by writing 0.
const ERROR_HISTORY: u16 = 0x1003;

/// Sets sub-index 0 to the highest sub-index, of 1003h to 0; it is added if it is missing and the object has others.
pub(super) fn count_members(index: u16, object: &mut ObjectDescription, span: Span) {
    // A count of nothing would hide that the sub-objects are missing.
    if !object.code.has_members() || object.entries.is_empty() {
        return;
    }
    let highest = highest(object).unwrap_or(0);
    let (name, access, value) = match index {
        ERROR_HISTORY => ("Number of errors", Access::Rw, 0),
        _ => ("Highest sub-index supported", Access::Const, highest),
    };
    let entry = object.entries.entry(0).or_insert_with(|| {
        let mut entry = EntryDescription::new(name, DataType::Unsigned8);
        entry.access = Spanned::new(access, span);
        entry.span = span;
        entry
    });
    entry.default = Some(Spanned::new(Value::Unsigned(u64::from(value)), span));
}

/// Returns whether SubNumber is the number of sub-indices.
pub(super) fn counts_sections(object: &ObjectDescription) -> bool {
    let number = object
        .sub_number
        .as_ref()
        .map(|number| number.value as usize);
    number == Some(object.entries.len())
}

pub(super) fn count_sections(object: &mut ObjectDescription, counted: bool) {
    if let (Some(number), true) = (&mut object.sub_number, counted) {
        // At most 256 sub-indices.
        number.value = object.entries.len() as u32;
    }
}
