use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::device;
use crate::subject::{Entry, start_number};

pub(crate) static RULE: Rule = Rule {
    code: "W0914",
    severity: Warning,
    title: "profile object has reserved bits",
    why: "A device that follows the profile aborts a download of the value, and a master may give the bits another meaning.",
    source: "CiA 401, object 6421h; CiA 402, object 6502h; CiA 406, object 6000h",
    says: "{object} is 0x{given:X}, but CiA {profile} reserves {reserved}",
    help: "write a value without {reserved}",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let (profile, mask, reserved) = match (entry.address.index, entry.address.sub) {
        (0x6421, 1..=254) => (401, 0xE0, "bits 5 to 7"),
        (0x6502, 0) => (402, 0xF800, "bits 11 to 15"),
        (0x6000, 0) => (406, 0x0FF0, "bits 4 to 11"),
        _ => return,
    };
    let number = start_number(entry.description, entry.address);
    if let Some(number) = number.filter(|number| number.value & mask != 0)
        && device(entry.description, profile).is_some()
    {
        let finding = RULE.on(entry, number.span).fact("object", entry.shown());
        let finding = finding
            .fact("given", number.value)
            .fact("reserved", reserved);
        findings.push(finding.fact("profile", u32::from(profile)));
    }
}
