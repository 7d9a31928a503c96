use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::transmission_type;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static I0542: Rule = Rule {
    title: "time of a TPDO has no effect",
    why: "The device uses inhibit time and event timer of a TPDO for the transmission types 254 and 255 only.",
    source: "CiA 301, TPDO communication parameter",
    says: "{name} is {given}, but transmission type {kind} does not use it",
    help: "write 0, or transmission type 254 or 255",
    check: Check::Object(check),
    ..Rule::of("I0542")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !matches!(object.index, 0x1800..=0x19FF) {
        return;
    }
    let kind = transmission_type(object);
    let Some(kind) = kind.filter(|kind| !kind.value.is_event_driven()) else {
        return;
    };
    for (sub, name) in [(3, "inhibit time"), (5, "event timer")] {
        let address = Address::new(object.index, sub);
        let given = start_number(object.description, address);
        if let Some(given) = given.filter(|given| given.value != 0) {
            let finding = I0542.on(object, given.span).about(address);
            let finding = finding.fact("name", name).fact("given", given.value);
            let finding = finding.fact("kind", kind.value.raw());
            findings.push(finding.related(kind.span, "transmission type set here"));
        }
    }
}
