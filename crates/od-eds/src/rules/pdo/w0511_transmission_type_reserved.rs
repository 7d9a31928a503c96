use alloc::vec::Vec;

use crate::finding::{Check, Finding, Form, Rule, Severity::Error};
use crate::rules::pdo::shared::transmission_type;
use crate::subject::Object;
use od_model::Address;

pub(crate) static W0511: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "transmission type is reserved",
    why: "CiA 301 defines 0 to 240 and 252 to 255, for an RPDO 0 to 240, 254 and 255. A device aborts the download of another value.",
    source: "CiA 301, PDO communication parameter",
    says: "transmission type {given} is reserved",
    help: "write 0 to 240, or 252 to 255",
    also: &[RPDO],
    check: Check::Object(check),
    ..Rule::of("W0511")
};

/// The help for an RPDO.
const RPDO: Form = Form {
    help: "write 0 to 240, 254 or 255",
    ..Form::OWN
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let is_rpdo = object.index < 0x1800;
    if let Some(given) = transmission_type(object)
        && given.value.is_reserved(is_rpdo)
    {
        let finding = W0511
            .on(object, given.span)
            .about(Address::new(object.index, 2))
            .fact("given", given.value.raw());
        findings.push(if is_rpdo {
            finding.form(&RPDO)
        } else {
            finding
        });
    }
}
