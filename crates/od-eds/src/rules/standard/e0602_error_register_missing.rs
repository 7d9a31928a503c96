use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::standard::shared::missing;

pub(crate) static E0602: Rule = Rule {
    code: "E0602",
    severity: Error,
    title: "object 1001h is missing",
    why: "A master that reads the error register gets an abort. EMCY messages carry its value.",
    source: "CiA 301, object 1001h",
    says: "mandatory object 1001h (error register) is missing",
    help: "add {missing}",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    findings.extend(missing(&E0602, description, 0x1001));
}
