//! What must hold in a description before a device is made of it.
//!
//! One rule or one family of rules a file. [`RULES`] says what every code means,
//! also those that the reader and the patches give. An error is what makes
//! generated code unsound or a master fail; what many shipped files have is a
//! warning.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, EntryDescription, Value};
use crate::finding::{Check, Finding, sort};
use crate::span::{Span, Spanned};
use crate::subject::objects;
use od_model::Address;

mod allow;
mod identity;
mod mandatory;
mod members;
mod modules;
mod pdo_counts;
mod profile;
mod sections;
mod services;
mod shape;
mod standard;
mod sub_index_0;

pub use crate::finding::{Fixability, Rule};
#[cfg(feature = "explain")]
pub use crate::rules::{Pair, pair};
pub use crate::rules::{RULES, rule};
pub use allow::{Allows, parse_allow};

/// All that is wrong with a description, in file order.
///
/// What the text was like is not seen here: [`parse`](crate::parse) names that.
pub fn check(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    for check in [
        mandatory::check,
        standard::check,
        services::check,
        members::check,
        shape::check,
        sub_index_0::check,
        pdo_counts::check,
        identity::check,
        sections::check,
        modules::check,
        profile::check,
    ] {
        check(description, &mut findings);
    }
    run(description, &mut findings);
    once(description, &mut findings);
    sort(&mut findings);
    findings
}

/// Runs the checks of all rules, in one pass over the objects.
fn run(description: &Description, findings: &mut Vec<Finding>) {
    let (mut of_entries, mut of_objects, mut of_device) = (Vec::new(), Vec::new(), Vec::new());
    for rule in RULES {
        match rule.check {
            Check::Entry(check) => of_entries.push(check),
            Check::Object(check) => of_objects.push(check),
            Check::Device(check) => of_device.push(check),
            Check::ByReader | Check::ByEdit => {}
        }
    }
    for object in objects(description) {
        for entry in object.entries() {
            of_entries.iter().for_each(|check| check(&entry, findings));
        }
        of_objects.iter().for_each(|check| check(&object, findings));
    }
    of_device
        .iter()
        .for_each(|check| check(description, findings));
}

/// Of members that one section stands for (CompactSubObj), the first is told about.
fn once(description: &Description, findings: &mut Vec<Finding>) {
    let mut told = BTreeSet::new();
    findings.retain(|finding| {
        let (Some(address), Some(span)) = (finding.object, finding.span()) else {
            return true;
        };
        let own = description.entry(address).map(|entry| entry.span);
        let object = description.objects.get(&address.index);
        let copied = own.is_some() && own == object.map(|object| object.span) && address.sub > 0;
        !copied || told.insert((finding.rule.code, span, address.index))
    });
}
/// The first of these places that is one in a text.
fn place(spans: &[Span]) -> Span {
    spans
        .iter()
        .copied()
        .find(|span| span.line != 0)
        .unwrap_or_default()
}

/// An address in a message: without sub-index where the object has no members.
fn named(description: &Description, address: Address) -> String {
    match description.objects.get(&address.index) {
        Some(object) if !object.code.has_members() && address.sub == 0 => {
            format!("{:04X}h", address.index)
        }
        _ => format!("{address}"),
    }
}

/// The value that an entry starts with: a DCF's ParameterValue, else the default.
fn start_value(entry: &EntryDescription) -> Option<&Spanned<Value>> {
    entry.parameter.as_ref().or(entry.default.as_ref())
}

/// The unsigned number that an entry starts with.
fn start_number(description: &Description, address: Address) -> Option<Spanned<u64>> {
    let value = start_value(description.entry(address)?)?;
    match value.value.integer(0) {
        Some(number) if !matches!(value.value, Value::NodeId(_)) => {
            let number = u64::try_from(number).ok()?;
            Some(Spanned::new(number, value.span))
        }
        _ => None,
    }
}
