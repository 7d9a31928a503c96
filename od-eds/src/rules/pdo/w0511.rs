use alloc::vec::Vec;

use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W0511",
    severity: Warning,
    title: "transmission type is reserved",
    why: "0–240 and 252–255 have a meaning, for an RPDO 0–240, 254 and 255.",
    source: "CiA 301, PDO communication parameter",
    says: "transmission type {given} is reserved",
    help: "a TPDO has 0–240 or 252–255",
    also: &[RPDO],
    check: Check::Object(check),
    ..Rule::NEW
};

/// What an RPDO says.
const RPDO: Form = Form {
    says: "transmission type {given} is reserved",
    help: "an RPDO has 0–240, 254 or 255",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let (last, rpdo) = match object.index {
        0x1400..=0x15FF => (253, true),
        0x1800..=0x19FF => (251, false),
        _ => return,
    };
    let address = Address::new(object.index, 2);
    if let Some(given) = start_number(object.description, address)
        && (241..=last).contains(&given.value)
    {
        let finding = RULE
            .on(object, given.span)
            .about(address)
            .fact("given", given.value);
        findings.push(if rpdo { finding.form(&RPDO) } else { finding });
    }
}
