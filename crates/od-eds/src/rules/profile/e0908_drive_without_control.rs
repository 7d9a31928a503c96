use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::profile::shared::{device, need};

pub(crate) static E0908: Rule = Rule {
    code: "E0908",
    severity: Error,
    buildable: true,
    title: "drive lacks its control or status",
    why: "A master that controls drives by CiA 402 gets an abort.",
    source: "CiA 402, object overview",
    says: "mandatory object {objects} ({what}) is missing",
    help: "add {missing}, or correct the profile number in bits 0 to 15 of 1000h",
    check: Check::Device(check),
    ..Rule::NEW
};

/// Objects that control a drive, with their names. A device of several axes has them 800h apart.
const OBJECTS: [(u16, &str); 2] = [(0x6040, "controlword"), (0x6041, "statusword")];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    if device(description, 402).is_some() {
        let objects = OBJECTS.iter();
        findings
            .extend(objects.filter_map(|(index, what)| need(&E0908, description, &[*index], what)));
    }
}
