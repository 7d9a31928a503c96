use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0535: Rule = Rule {
    title: "inhibit time is longer than the event timer",
    why: "The device cannot send the TPDO as often as the event timer says.",
    source: "CiA 301, PDO communication parameter",
    says: "event timer is {event} ms, but the inhibit time is {inhibit} × 100 µs",
    help: "write an event timer of at least {least} ms, or a shorter inhibit time",
    check: Check::Object(check),
    ..Rule::of("W0535")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !matches!(object.index, 0x1800..=0x19FF) {
        return;
    }
    let at = |sub| start_number(object.description, Address::new(object.index, sub));
    if let Some((inhibit, event)) = at(3).zip(at(5))
        && (1..inhibit.value.div_ceil(10)).contains(&event.value)
    {
        let finding = W0535
            .on(object, event.span)
            .about(Address::new(object.index, 5));
        let finding = finding
            .fact("event", event.value)
            .fact("inhibit", inhibit.value);
        let finding = finding.fact("least", inhibit.value.div_ceil(10));
        findings.push(finding.related(inhibit.span, "inhibit time set here"));
    }
}
