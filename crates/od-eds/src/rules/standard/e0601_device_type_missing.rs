use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::standard::shared::missing;

pub(crate) static E0601: Rule = Rule {
    code: "E0601",
    severity: Error,
    title: "object 1000h is missing",
    why: "A master reads the device type first, and gets an abort.",
    source: "CiA 301, object 1000h",
    says: "mandatory object 1000h (device type) is missing",
    help: "add {missing}",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    findings.extend(missing(&E0601, description, 0x1000));
}
