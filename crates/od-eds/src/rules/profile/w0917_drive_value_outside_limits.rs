use alloc::vec::Vec;
use core::cmp::Ordering;

use crate::description::{Description, Value};
use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule};
use crate::rules::profile::shared::device;
use crate::rules::values::limits::order;
use crate::span::Spanned;
use crate::subject::{Entry, start_number, start_value};
use od_model::Address;

pub(crate) static W0917: Rule = Rule {
    title: "value of a drive is outside its limits",
    why: "The drive has less speed or torque than a master that reads the value expects, stops at a limit, or aborts the download of the value.",
    source: "CiA 402, objects 6072h, 607Dh, 607Fh, 60C5h and 60C6h",
    says: "{object} is {given}, but its maximum ({limit}) is {most}",
    help: "write {most} or less, or raise {limit}",
    also: &[POSITION],
    check: Check::Entry(check),
    ..Rule::of("W0917")
};

/// Sentence for a target position outside the software position limits.
const POSITION: Form = Form {
    says: "{object} is {given}, but the software position limits (607Dh) are {low} and {high}",
    help: "write a position between {low} and {high}, or correct 607Dh",
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let limit = match (entry.address.index, entry.address.sub) {
        (0x6071, 0) => 0x6072,
        (0x6081, 0) => 0x607F,
        (0x6083, 0) => 0x60C5,
        (0x6084 | 0x6085, 0) => 0x60C6,
        (0x607A, 0) => return findings.extend(position(entry)),
        _ => return,
    };
    let number = |address| start_number(entry.description, address);
    if let Some((given, most)) = number(entry.address).zip(number(Address::new(limit, 0)))
        // A maximum of 0 means: not set.
        && most.value > 0
        && given.value > most.value
        && device(entry.description, 402).is_some()
    {
        let finding = W0917.on(entry, given.span).fact("object", entry.shown());
        let finding = finding.fact("given", given.value).fact("most", most.value);
        let finding = finding.fact("limit", Fact::Index(limit));
        findings.push(finding.related(most.span, "maximum set here"));
    }
}

/// The finding about a target position that the limits of positions do not allow. Limits of which the lower one is not
/// below the upper one are not used, and a home offset (607Ch) moves them.
fn position(entry: &Entry<'_>) -> Option<Finding> {
    device(entry.description, 402)?;
    let given = start_value(entry)?;
    let [low, high] = [1, 2].map(|sub| value(entry.description, 0x607D, sub));
    let (low, high) = low.zip(high)?;
    let is_moved = value(entry.description, 0x607C, 0).is_some_and(|own| own.integer(0) != Some(0));
    let is_outside = order(low, given) == Some(Ordering::Greater)
        || order(given, high) == Some(Ordering::Greater);
    if is_moved || !is_outside || order(low, high) != Some(Ordering::Less) {
        return None;
    }
    let finding = W0917.on(entry, given.span).form(&POSITION);
    let finding = finding.fact("object", entry.shown());
    let finding = finding.fact("given", given.value.clone());
    let finding = finding.fact("low", low.value.clone());
    Some(finding.fact("high", high.value.clone()))
}

fn value(description: &Description, index: u16, sub: u8) -> Option<&Spanned<Value>> {
    start_value(description.entry(Address::new(index, sub))?)
}
