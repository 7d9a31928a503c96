use alloc::vec::Vec;

use crate::finding::{Check, Finding, Form, Rule};
use crate::rules::pdo::shared::mapped;
use crate::subject::{Entry, Object};

pub(crate) static E0503: Rule = Rule {
    title: "PDO maps an object of the wrong direction",
    why: "A TPDO sends values that a master can read (`ro`, `rw`, `rwr`, `const`), an RPDO values that a master can write (`wo`, `rw`, `rww`).",
    source: "CiA 306-1, AccessType",
    says: "{object} \"{name}\" is `{access}` and cannot be mapped into a TPDO",
    help: "map an object with {AccessType} `ro`, `rw`, `rwr` or `const`",
    also: &[RPDO],
    check: Check::Object(check),
    ..Rule::of("E0503")
};

/// The sentences for an RPDO.
const RPDO: Form = Form {
    says: "{object} \"{name}\" is `{access}` and cannot be mapped into an RPDO",
    help: "map an object with {AccessType} `wo`, `rw` or `rww`",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        let wrong = |value: &Entry<'_>| *value.mappable && !mapped.takes(value);
        let Some(value) = mapped.value().filter(wrong) else {
            continue;
        };
        let finding = mapped.finding(&E0503).fact("object", value.shown());
        let finding = finding
            .fact("name", value.name.as_str())
            .fact("access", *value.access);
        let finding = finding.related(value.access.span.or(value.span), "{AccessType} set here");
        findings.push(if mapped.rpdo {
            finding.form(&RPDO)
        } else {
            finding
        });
    }
}
