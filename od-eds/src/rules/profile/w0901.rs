use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::{device, need};

pub(crate) static RULE: Rule = Rule {
    code: "W0901",
    severity: Warning,
    title: "I/O module lacks the objects of its channels",
    why: "A master that reads from 1000h which channels exist finds no object for them.",
    source: "CiA 401, object 1000h",
    says: "1000h declares {what}, but object {objects} is missing",
    help: "add {missing}, or clear bit {bit} of 1000h",
    check: Check::Device(check),
    ..Rule::NEW
};

/// A bit of 1000h, the objects one of which it announces, and the channels.
const BLOCKS: [(u32, &[u16], &str); 4] = [
    (0, &[0x6000, 0x6100, 0x6120], "digital inputs"),
    (1, &[0x6200, 0x6300, 0x6320], "digital outputs"),
    (
        2,
        &[0x6400, 0x6401, 0x6402, 0x6403, 0x6404],
        "analogue inputs",
    ),
    (
        3,
        &[0x6410, 0x6411, 0x6412, 0x6413, 0x6414],
        "analogue outputs",
    ),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device(description, 401) else {
        return;
    };
    let blocks = BLOCKS.iter().filter(|(bit, _, _)| device.has(*bit));
    findings.extend(blocks.filter_map(|(bit, any_of, what)| {
        let finding = need(&RULE, description, any_of, what)?;
        Some(finding.fact("bit", bit + 16))
    }));
}
