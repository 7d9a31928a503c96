use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
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
    // A file without objects has a rule of its own.
    if !description.objects.is_empty() && !description.objects.contains_key(&0x1000) {
        let finding = RULE.finding().about(Address::new(0x1000, 0));
        findings.push(finding.fact("missing", Fact::Section(0x1000, None)));
    }
}
