use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static E0537: Rule = Rule {
    code: "E0537",
    severity: Error,
    buildable: true,
    title: "multiplexed PDO is synchronous",
    why: "A multiplexed PDO is event-driven: with a synchronous type the device cannot send what changes, and a receiver takes the values at the wrong time.",
    source: "CiA 301, MPDO protocol",
    says: "transmission type {given} is not valid for a multiplexed PDO",
    help: "write 254 or 255",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let description = object.description;
    if !matches!(object.index, 0x1400..=0x15FF | 0x1800..=0x19FF) {
        return;
    }
    let count = start_number(description, Address::new(object.index + 0x200, 0));
    let address = Address::new(object.index, 2);
    if let Some(count) = count.filter(|count| matches!(count.value, 254 | 255))
        && let Some(given) = start_number(description, address)
        && given.value < 254
    {
        let finding = E0537.on(object, given.span).about(address);
        let finding = finding.fact("given", given.value);
        findings.push(finding.related(count.span, "multiplexed by this number"));
    }
}
