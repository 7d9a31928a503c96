use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::transmission_type;
use crate::subject::Object;
use od_model::Address;

pub(crate) static W0529: Rule = Rule {
    title: "PDO waits for SYNC, but 1005h is missing",
    why: "Transmission types 0 to 240 and 252 depend on SYNC, whose COB-ID is in 1005h. Type 253 does not: its PDO is sent at the request.",
    source: "CiA 301, PDO communication parameter",
    says: "transmission type {given} needs object 1005h (COB-ID SYNC message)",
    help: "add {missing}, or write a transmission type without SYNC, such as 255",
    check: Check::Object(check),
    ..Rule::of("W0529")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if let Some(given) = transmission_type(object)
        && given.value.is_sampled_at_sync()
        && !given.value.is_reserved(false)
        && !object.description.objects.contains_key(&0x1005)
    {
        findings.push(
            W0529
                .on(object, given.span)
                .about(Address::new(object.index, 2))
                .fact("given", given.value.raw())
                .fact("missing", Fact::Section(0x1005, None)),
        );
    }
}
