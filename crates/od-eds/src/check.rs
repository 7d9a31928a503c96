//! Checks: passes each object and value to the rules.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use crate::description::{Description, EntryDescription, ObjectDescription};
use crate::finding::{Check, Finding, sort};
use crate::log::Log;
use crate::read::modules::modules;
use crate::span::Span;
use crate::subject::{Object, objects};

pub use crate::allow::{Allows, parse_allow};
pub use crate::codes::{all, rule};
pub use crate::finding::{Fixability, Rule};
pub use crate::rules::RULES;
#[cfg(feature = "explain")]
pub use crate::rules::{Pair, pair};

/// Runs all checks and returns the findings in file order.
///
/// Findings about the text itself come from [`parse`](crate::parse()).
pub fn check(description: &Description) -> Vec<Finding> {
    let mut log = Log::default();
    run(description, &mut log);
    let mut findings = log.finish();
    sort(&mut findings);
    findings
}

/// Runs the checks of all rules, in one pass over the objects.
pub(crate) fn run(description: &Description, log: &mut Log) {
    let (mut of_entries, mut of_objects, mut of_device) = (Vec::new(), Vec::new(), Vec::new());
    for rule in RULES {
        match rule.check {
            Check::Entry(check) => of_entries.push(check),
            Check::Object(check) => of_objects.push(check),
            Check::Device(check) => of_device.push(check),
            Check::Elsewhere => {}
        }
    }
    let mut found = Vec::new();
    let mut report = |found: &mut Vec<Finding>| {
        once(description, found);
        log.extend(found.drain(..));
    };
    for object in objects(description) {
        for entry in object.entries() {
            let checks = of_entries.iter();
            checks.for_each(|check| check(&entry, &mut found));
        }
        let checks = of_objects.iter();
        checks.for_each(|check| check(&object, &mut found));
        report(&mut found);
    }
    // The objects that a device has while a module is plugged in.
    let mut whole = None;
    for module in modules(description) {
        let own = Description {
            objects: module.fixed,
            ..Description::default()
        };
        for entry in objects(&own).flat_map(|object| object.entries()) {
            of_entries
                .iter()
                .for_each(|check| check(&entry, &mut found));
        }
        report(&mut found);
        for (index, extension) in &module.extensions {
            let base = description.objects.get(index).or(own.objects.get(index));
            let Some(base) = base else {
                continue;
            };
            let whole = whole.get_or_insert_with(|| description.clone());
            let before = whole
                .objects
                .insert(*index, extended(base, &extension.entry));
            if let Some(object) = Object::of(whole, *index) {
                for entry in object.entries() {
                    let checks = of_entries.iter();
                    checks.for_each(|check| check(&entry, &mut found));
                }
                let checks = of_objects.iter();
                checks.for_each(|check| check(&object, &mut found));
            }
            match before {
                Some(before) => drop(whole.objects.insert(*index, before)),
                None => drop(whole.objects.remove(index)),
            }
            let is_own = |span| is_in(&extension.entry, span);
            found.retain(|finding| finding.span().is_some_and(is_own));
            report(&mut found);
        }
    }
    for check in of_device {
        check(description, &mut found);
        report(&mut found);
    }
}

/// An object with its first two values and one that a module adds. A module may add a value to an object with many, so
/// the others are left out.
fn extended(base: &ObjectDescription, added: &EntryDescription) -> ObjectDescription {
    let first = base.entries.iter().take(2);
    let mut entries: BTreeMap<u8, EntryDescription> =
        first.map(|(sub, entry)| (*sub, entry.clone())).collect();
    let last = entries.keys().next_back().copied();
    entries.insert(last.unwrap_or(0).saturating_add(1), added.clone());
    ObjectDescription {
        code: base.code,
        name: base.name.clone(),
        sub_number: None,
        entries,
        flags: base.flags,
        extra: Vec::new(),
        span: base.span,
    }
}

/// Returns whether a place is in the section of a value.
fn is_in(entry: &EntryDescription, span: Span) -> bool {
    let values = [&entry.default, &entry.low, &entry.high]
        .into_iter()
        .flatten();
    let places = [entry.span, entry.access.span, entry.mappable.span];
    let mut places = places
        .into_iter()
        .chain(entry.data_type.map(|data_type| data_type.span))
        .chain(values.map(|value| value.span));
    places.any(|own| own == span)
}

/// Keeps only the first of equal findings about sub-objects that one section describes (CompactSubObj).
fn once(description: &Description, findings: &mut Vec<Finding>) {
    let mut known = BTreeSet::new();
    findings.retain(|finding| {
        let (Some(address), Some(span)) = (finding.object, finding.span()) else {
            return true;
        };
        let own = description.entry(address).map(|entry| entry.span);
        let object = description.objects.get(&address.index);
        let copied = own.is_some() && own == object.map(|object| object.span) && address.sub > 0;
        !copied || known.insert((finding.rule.code, span, address.index))
    });
}
