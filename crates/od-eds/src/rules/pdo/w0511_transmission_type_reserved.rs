use alloc::vec::Vec;

use crate::finding::{Check, Finding, Form, Rule, Severity::Error};
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0511: Rule = Rule {
    code: "W0511",
    severity: Error,
    buildable: true,
    title: "transmission type is reserved",
    why: "CiA 301 defines 0 to 240 and 252 to 255, for an RPDO 0 to 240, 254 and 255. A device aborts the download of another value.",
    source: "CiA 301, PDO communication parameter",
    says: "transmission type {given} is reserved",
    help: "write 0 to 240, or 252 to 255",
    also: &[RPDO],
    check: Check::Object(check),
    ..Rule::NEW
};

/// The help for an RPDO.
const RPDO: Form = Form {
    help: "write 0 to 240, 254 or 255",
    ..Form::OWN
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
        let finding = W0511
            .on(object, given.span)
            .about(address)
            .fact("given", given.value);
        findings.push(if rpdo { finding.form(&RPDO) } else { finding });
    }
}
