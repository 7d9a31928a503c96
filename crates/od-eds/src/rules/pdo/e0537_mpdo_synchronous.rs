use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::transmission_type;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static E0537: Rule = Rule {
    buildable: true,
    title: "multiplexed PDO is synchronous",
    why: "A multiplexed PDO is event-driven: with a synchronous type the device cannot send what changes, and a receiver takes the values at the wrong time.",
    source: "CiA 301, MPDO protocol",
    fixability: Fixability::Unsafe,
    says: "transmission type {given} is not valid for a multiplexed PDO",
    help: "write 254{fix} or 255",
    check: Check::Object(check),
    ..Rule::of("E0537")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let Some(given) = transmission_type(object).filter(|given| !given.value.is_event_driven())
    else {
        return;
    };
    let count = Address::new(object.index + 0x200, 0);
    if let Some(count) = start_number(object.description, count)
        && matches!(count.value, 254 | 255)
    {
        let finding = E0537
            .on(object, given.span)
            .about(Address::new(object.index, 2));
        let finding = finding.fact("given", given.value.raw());
        let finding = finding.fix(Fix::unsafe_fix().replace(given.span, "254"));
        findings.push(finding.related(count.span, "multiplexed by this number"));
    }
}
