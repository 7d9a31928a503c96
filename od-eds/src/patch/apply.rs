//! Edits applied: strictly, in their order, with a finding for each that cannot be.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::count::{count_members, count_sections, counted, counts_sections};
use super::{Action, Change, Edit, Raw, Target, finding, missing};
use crate::description::{Description, EntryDescription, ObjectDescription, Value};
use crate::fact::Key;
use crate::finding::Finding;
use crate::rules;
use crate::span::{Span, Spanned};
use od_model::DataType;

/// Applies the edits in their order and returns what was wrong with them.
///
/// An edit with a fault does what of it makes sense, so that one mistake is one
/// finding.
///
/// Sub-index 0 follows: an object that the patch adds without one gets one
/// (UNSIGNED8, `const`), and where it held the highest sub-index before the patch
/// added or removed members, it does so afterwards. An edit of sub-index 0 itself
/// has the last word.
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
            count_members(object, span);
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
            Change::Code(_) => findings.push(code_of_member(change, target)),
            other if !has_value => findings.push(value_of_container(change.span, target, other)),
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
    if description.objects.contains_key(&target.index) {
        findings.push(already(edit));
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
                findings.push(value_of_container(change.span, target, &change.value));
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
        findings.push(
            finding(
                &rules::E0703,
                edit.target.span,
                target,
                format!(
                    "{target} has no object to stand in: {:04X}h does not exist",
                    target.index
                ),
            )
            .with_help(format!(
                "add the object first: `add 0x{:04X} {{ code = record; name = \"…\" }}`",
                target.index
            )),
        );
        return;
    };
    if !object.code.has_members() {
        findings.push(
            finding(
                &rules::E0704,
                edit.target.span,
                target,
                format!("{:04X}h is a {}: it has no members", target.index, *object.code),
            )
            .with_help("only a RECORD or an ARRAY has sub-indices; remove the object and add it with `code = record`"),
        );
        return;
    }
    if object.entries.contains_key(&sub) {
        findings.push(already(edit));
        return;
    }
    for change in &edit.changes {
        if matches!(change.value, Change::Code(_)) {
            findings.push(code_of_member(change, target));
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
    let target = *edit.target;
    findings.push(
        finding(
            &rules::E0705,
            edit.target.span,
            target,
            format!("`add {target}` gives no name"),
        )
        .with_help("say `name = \"…\"`: the handle is called after it"),
    );
    Spanned::new(target.to_string(), edit.target.span)
}

/// The entry that an `add` describes, without its name; `None` if it has no type.
fn make(edit: &Edit, findings: &mut Vec<Finding>) -> Option<EntryDescription> {
    let target = *edit.target;
    let Some(data_type) = edit.changes.iter().find_map(|change| match change.value {
        Change::Type(data_type) => Some(data_type),
        _ => None,
    }) else {
        findings.push(
            finding(
                &rules::E0706,
                edit.target.span,
                target,
                format!("`add {target}` gives no type"),
            )
            .with_help("say `type = u16`, `type = str`, `type = UNSIGNED24` …"),
        );
        return None;
    };
    let mut entry = EntryDescription::new("", data_type);
    entry.span = edit.target.span;
    entry.access.span = edit.target.span;
    fill(&mut entry, edit, findings);
    Some(entry)
}

/// Writes the fields of an edit into an entry; the values after the type that they are of.
fn fill(entry: &mut EntryDescription, edit: &Edit, findings: &mut Vec<Finding>) {
    let target = *edit.target;
    let gives = |key: Key| edit.changes.iter().any(|change| change.key() == key);
    for change in &edit.changes {
        let span = change.span;
        match &change.value {
            Change::Name(name) => entry.name = Spanned::new(name.clone(), span),
            Change::Access(access) => entry.access = Spanned::new(*access, span),
            Change::Mappable(mappable) => entry.mappable = Spanned::new(*mappable, span),
            Change::Save(group) => entry.group = Some(Spanned::new(*group, span)),
            Change::Type(data_type) => {
                entry.data_type = Some(Spanned::new(*data_type, span));
                for (key, field, value) in [
                    (Key::DefaultValue, "default", &mut entry.default),
                    (Key::LowLimit, "low", &mut entry.low),
                    (Key::HighLimit, "high", &mut entry.high),
                ] {
                    if !gives(key) {
                        findings.extend(retype(field, value, *data_type, span, target));
                    }
                }
            }
            Change::Code(_) | Change::Default(_) | Change::Low(_) | Change::High(_) => {}
        }
    }
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
        match raw.as_ref().map(|raw| raw.value_for(data_type)) {
            None => *field = None,
            Some(Ok(value)) => *field = Some(Spanned::new(value, change.span)),
            Some(Err(fault)) => findings.push(
                finding(
                    &rules::E0707,
                    change.span,
                    target,
                    format!("`{}`: {}", change.field(), fault.message),
                )
                .with_help(fault.help),
            ),
        }
    }
    // A DCF's value would hide the default that the edit gives.
    if gives(Key::DefaultValue) {
        entry.parameter = None;
    }
}

/// Gives a value that stays the form that the entry's new type wants.
fn retype(
    key: &str,
    field: &mut Option<Spanned<Value>>,
    data_type: DataType,
    at: Span,
    target: Target,
) -> Option<Finding> {
    let old = field.take()?;
    match Raw::from(&old.value).value_for(data_type) {
        Ok(value) => {
            *field = Some(Spanned::new(value, old.span));
            None
        }
        Err(fault) => Some(
            finding(
                &rules::E0708,
                at,
                target,
                format!(
                    "the {key} of the base does not fit the new type: {}",
                    fault.message
                ),
            )
            .with_help(format!("give `{key}` with the type, or `{key} = none`")),
        ),
    }
}

fn already(edit: &Edit) -> Finding {
    let target = *edit.target;
    let what = match target.sub {
        None => format!("{:04X}h", target.index),
        Some(_) => target.address().to_string(),
    };
    finding(
        &rules::E0702,
        edit.target.span,
        target,
        format!("{what} is there already"),
    )
    .with_help(format!("to change it, write `modify {target} {{ … }}`"))
}

fn code_of_member(change: &Spanned<Change>, target: Target) -> Finding {
    finding(
        &rules::E0709,
        change.span,
        target,
        format!("{target} is a member: it has no object code"),
    )
    .with_help(format!(
        "`code` stands in the object: `0x{:04X} {{ code = record }}`",
        target.index
    ))
}

fn value_of_container(at: Span, target: Target, change: &Change) -> Finding {
    finding(
        &rules::E0710,
        at,
        target,
        format!(
            "{:04X}h has members: `{}` belongs to one of them",
            target.index,
            change.field()
        ),
    )
    .with_help(format!(
        "name the member, for example `0x{:04X}sub1`",
        target.index
    ))
}
