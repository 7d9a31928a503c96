use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::{device, need};

pub(crate) static W0902: Rule = Rule {
    code: "W0902",
    severity: Warning,
    title: "drive lacks its supported modes",
    why: "A master that chooses a mode by CiA 402 gets an abort.",
    source: "CiA 402, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    if device(description, 402).is_some() {
        findings.extend(need(
            &W0902,
            description,
            &[0x6502],
            "supported drive modes",
        ));
    }
}
