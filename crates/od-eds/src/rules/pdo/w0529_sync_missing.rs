use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::pdo::shared::is_communication;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0529: Rule = Rule {
    code: "W0529",
    severity: Warning,
    title: "PDO waits for SYNC, but 1005h is missing",
    why: "Transmission types 0 to 240 and 252 depend on SYNC, whose COB-ID is in 1005h. Type 253 does not: its PDO is sent at the request.",
    source: "CiA 301, PDO communication parameter",
    says: "transmission type {given} needs object 1005h (COB-ID SYNC message)",
    help: "add {missing}, or write a transmission type without SYNC, such as 255",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let description = object.description;
    if !is_communication(object.index) || description.objects.contains_key(&0x1005) {
        return;
    }
    let address = Address::new(object.index, 2);
    if let Some(given) = start_number(description, address)
        && matches!(given.value, 0..=240 | 252)
    {
        findings.push(
            W0529
                .on(object, given.span)
                .about(address)
                .fact("given", given.value)
                .fact("missing", Fact::Section(0x1005, None)),
        );
    }
}
