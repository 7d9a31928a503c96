//! Applies edits strictly and in their order, with a finding for each one that is impossible.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::count::{count_members, count_sections, counted, counts_sections};
use super::{Action, Change, Edit, Raw, Target, missing};
use crate::description::{Description, EntryDescription, ObjectDescription, Value};
use crate::fact::Key;
use crate::finding::Finding;
use crate::read::fields::STORAGE;
use crate::rules::edits::{
    e0702_object_exists, e0703_sub_object_without_object, e0704_added, e0705_name_missing,
    e0706_type_missing, e0707_value_not_valid, e0708_value_of_base_not_valid,
    e0709_sub_object_with_object_code, e0710_value_of_object_with_sub_objects, e0711_capacity,
    e0711_limit, e0711_mappable, e0712_index_of_data_types,
};
use crate::span::{Span, Spanned};
use od_model::{DataType, Kind};

/// Applies the edits in their order and returns the problems.
///
/// A wrong edit is applied as far as it makes sense, so that one mistake is one
/// finding.
///
/// Sub-index 0 is updated: an object that the patch adds without one gets one
/// (UNSIGNED8, `const`), and if it held the highest sub-index before the patch
/// added or removed members, it does so afterwards. An edit of sub-index 0 itself
/// has priority.
#[must_use]
pub fn apply(description: &mut Description, edits: &[Edit]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let counted = counted(description, edits);
    for edit in edits {
        match (edit.action, edit.target.sub) {
            (Action::Remove, _) => remove(description, edit, &mut findings),
            (Action::Modify, _) => modify(description, edit, &mut findings),
            (Action::Add, None) => add_object(description, edit, &mut findings),
            (Action::Add, Some(_)) => add_member(description, edit, &mut findings),
        }
    }
    for (index, span) in counted {
        if let Some(object) = description.objects.get_mut(&index) {
            count_members(index, object, span);
        }
    }
    findings
}

fn remove(description: &mut Description, edit: &Edit, findings: &mut Vec<Finding>) {
    let target = *edit.target;
    if let Some(fault) = missing(description, &edit.target) {
        findings.push(fault);
        return;
    }
    match target.sub {
        None => {
            description.objects.remove(&target.index);
        }
        Some(sub) => {
            if let Some(object) = description.objects.get_mut(&target.index) {
                let counted = counts_sections(object);
                object.entries.remove(&sub);
                count_sections(object, counted);
            }
        }
    }
}

fn modify(description: &mut Description, edit: &Edit, findings: &mut Vec<Finding>) {
    let target = *edit.target;
    if let Some(fault) = missing(description, &edit.target) {
        findings.push(fault);
        return;
    }
    let Some(object) = description.objects.get_mut(&target.index) else {
        return;
    };
    let whole = target.sub.is_none();
    let has_value = !whole || !object.code.has_members();
    for change in &edit.changes {
        match &change.value {
            Change::Code(code) if whole => object.code = Spanned::new(*code, change.span),
            Change::Name(name) if whole => object.name = Spanned::new(name.clone(), change.span),
            Change::Code(_) => {
                findings.push(e0709_sub_object_with_object_code(&edit.target, change.span))
            }
            other if !has_value => {
                findings.push(e0710_value_of_object_with_sub_objects(
                    &edit.target,
                    change.span,
                    other.key(),
                ));
            }
            _ => {}
        }
    }
    if !has_value {
        return;
    }
    if let Some(entry) = object.entries.get_mut(&target.address().sub) {
        fill(entry, edit, findings);
    }
}

fn add_object(description: &mut Description, edit: &Edit, findings: &mut Vec<Finding>) {
    let target = *edit.target;
    if target.index < 0x1000 {
        findings.push(e0712_index_of_data_types(&edit.target));
        return;
    }
    if description.objects.contains_key(&target.index) {
        findings.push(e0702_object_exists(&edit.target));
        return;
    }
    let code = edit.changes.iter().find_map(|change| match change.value {
        Change::Code(code) => Some(Spanned::new(code, change.span)),
        _ => None,
    });
    let code = code.unwrap_or_default();
    let name = name_of(edit, findings);
    let mut object = ObjectDescription {
        code,
        name,
        sub_number: None,
        entries: Default::default(),
        flags: 0,
        extra: Vec::new(),
        span: edit.target.span,
    };
    if code.has_members() {
        for change in &edit.changes {
            if !matches!(change.value, Change::Code(_) | Change::Name(_)) {
                findings.push(e0710_value_of_object_with_sub_objects(
                    &edit.target,
                    change.span,
                    change.key(),
                ));
            }
        }
    } else if let Some(entry) = make(edit, findings) {
        object.entries.insert(0, entry);
    }
    description.objects.insert(target.index, object);
}

fn add_member(description: &mut Description, edit: &Edit, findings: &mut Vec<Finding>) {
    let target = *edit.target;
    let sub = target.address().sub;
    let Some(object) = description.objects.get_mut(&target.index) else {
        findings.push(e0703_sub_object_without_object(&edit.target));
        return;
    };
    if !object.code.has_members() {
        findings.push(e0704_added(&edit.target, *object.code));
        return;
    }
    if object.entries.contains_key(&sub) {
        findings.push(e0702_object_exists(&edit.target));
        return;
    }
    for change in &edit.changes {
        if matches!(change.value, Change::Code(_)) {
            findings.push(e0709_sub_object_with_object_code(&edit.target, change.span));
        }
    }
    if let Some(mut entry) = make(edit, findings) {
        entry.name = name_of(edit, findings);
        let counted = counts_sections(object);
        object.entries.insert(sub, entry);
        count_sections(object, counted);
    }
}

fn name_of(edit: &Edit, findings: &mut Vec<Finding>) -> Spanned<String> {
    for change in &edit.changes {
        if let Change::Name(name) = &change.value {
            return Spanned::new(name.clone(), change.span);
        }
    }
    findings.push(e0705_name_missing(&edit.target));
    Spanned::new(edit.target.to_string(), edit.target.span)
}

/// The entry of an `add`, without its name; `None` if it has no type.
fn make(edit: &Edit, findings: &mut Vec<Finding>) -> Option<EntryDescription> {
    let Some(data_type) = edit.changes.iter().find_map(|change| match change.value {
        Change::Type(data_type) => Some(data_type),
        _ => None,
    }) else {
        findings.push(e0706_type_missing(&edit.target));
        return None;
    };
    let mut entry = EntryDescription::new("", data_type);
    entry.span = edit.target.span;
    entry.access.span = edit.target.span;
    fill(&mut entry, edit, findings);
    Some(entry)
}

/// Writes the fields of an edit into an entry, the type before the values.
fn fill(entry: &mut EntryDescription, edit: &Edit, findings: &mut Vec<Finding>) {
    let gives = |key: Key| edit.changes.iter().any(|change| change.key() == key);
    for change in &edit.changes {
        let span = change.span;
        match &change.value {
            Change::Name(name) => entry.name = Spanned::new(name.clone(), span),
            Change::Access(access) => entry.access = Spanned::new(*access, span),
            Change::Save(group) => {
                entry.group = Some(Spanned::new(*group, span));
                entry.extra.retain(|(key, _)| key != STORAGE);
            }
            Change::Type(data_type) => {
                entry.data_type = Some(Spanned::new(*data_type, span));
                for (key, value) in [
                    (Key::DefaultValue, &mut entry.default),
                    (Key::LowLimit, &mut entry.low),
                    (Key::HighLimit, &mut entry.high),
                ] {
                    if !gives(key) {
                        findings.extend(retype(&edit.target, span, key, value, *data_type));
                    }
                }
            }
            Change::Code(_)
            | Change::Mappable(_)
            | Change::Capacity(_)
            | Change::Default(_)
            | Change::Low(_)
            | Change::High(_) => {}
        }
    }
    fill_length(entry, edit, findings);
    let Some(data_type) = entry.data_type.map(|t| t.value) else {
        return;
    };
    for change in &edit.changes {
        let (field, raw) = match &change.value {
            Change::Default(raw) => (&mut entry.default, raw),
            Change::Low(raw) => (&mut entry.low, raw),
            Change::High(raw) => (&mut entry.high, raw),
            _ => continue,
        };
        let is_limit = change.key() != Key::DefaultValue;
        match raw {
            None => *field = None,
            Some(_) if is_limit && matches!(data_type.kind(), Kind::Text | Kind::Bytes) => {
                let finding = e0711_limit(&edit.target, change.span, change.key(), data_type);
                findings.push(finding);
            }
            Some(raw) => match raw.value_for(data_type) {
                Some(value) => *field = Some(Spanned::new(value, change.span)),
                None => {
                    let (at, given) = (change.span, raw.to_string());
                    let finding =
                        e0707_value_not_valid(&edit.target, at, change.key(), &given, data_type);
                    findings.push(finding);
                }
            },
        }
    }
    // The value of a DCF would hide the default of the edit.
    if gives(Key::DefaultValue) {
        entry.parameter = None;
    }
}

/// Writes the fields that depend on whether values of the type have a fixed length.
fn fill_length(entry: &mut EntryDescription, edit: &Edit, findings: &mut Vec<Finding>) {
    let data_type = entry.data_type.map(|given| given.value);
    let fixed = data_type.map(|data_type| (data_type, data_type.bits().is_some()));
    for change in &edit.changes {
        match (&change.value, fixed) {
            (Change::Mappable(true), Some((data_type, false))) => {
                let finding = e0711_mappable(&edit.target, change.span, data_type);
                findings.push(finding);
            }
            (Change::Capacity(_), Some((data_type, true))) => {
                let finding = e0711_capacity(&edit.target, change.span, data_type);
                findings.push(finding);
            }
            (Change::Mappable(mappable), _) => {
                entry.mappable = Spanned::new(*mappable, change.span);
            }
            (Change::Capacity(bytes), _) => entry.capacity = Some(*bytes),
            _ => {}
        }
    }
}

/// Converts a value that stays into the new type of the entry.
fn retype(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    field: &mut Option<Spanned<Value>>,
    data_type: DataType,
) -> Option<Finding> {
    let old = field.take()?;
    let given = Raw::from(&old.value);
    match given.value_for(data_type) {
        Some(value) => *field = Some(Spanned::new(value, old.span)),
        None => {
            return Some(e0708_value_of_base_not_valid(
                target,
                at,
                key,
                &given.to_string(),
                data_type,
            ));
        }
    }
    None
}
