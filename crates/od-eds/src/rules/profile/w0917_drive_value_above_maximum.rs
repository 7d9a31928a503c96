use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::subject::{Entry, start_number};
use od_model::Address;

pub(crate) static W0917: Rule = Rule {
    title: "value of a drive is above its maximum",
    why: "The drive has less speed or torque than a master that reads the value expects, or aborts its download.",
    source: "CiA 402, objects 6072h, 607Fh, 60C5h and 60C6h",
    says: "{object} is {given}, but its maximum ({limit}) is {most}",
    help: "write {most} or less, or raise {limit}",
    check: Check::Entry(check),
    ..Rule::of("W0917")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let limit = match (entry.address.index, entry.address.sub) {
        (0x6071, 0) => 0x6072,
        (0x6081, 0) => 0x607F,
        (0x6083, 0) => 0x60C5,
        (0x6084 | 0x6085, 0) => 0x60C6,
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
