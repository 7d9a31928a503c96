use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::standard::shared::missing;

pub(crate) static E0603: Rule = Rule {
    code: "E0603",
    severity: Error,
    title: "object 1018h is missing",
    why: "A master cannot identify the device.",
    source: "CiA 301, object 1018h",
    says: "mandatory object 1018h (identity object) is missing",
    help: "add {missing}",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    findings.extend(missing(&E0603, description, 0x1018));
}
