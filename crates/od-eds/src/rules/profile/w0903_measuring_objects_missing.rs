use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::{device, need};

pub(crate) static W0903: Rule = Rule {
    code: "W0903",
    severity: Warning,
    title: "measuring device lacks the objects of its blocks",
    why: "A master that reads from 1000h which function blocks exist finds no process values for them.",
    source: "CiA 404, object 1000h",
    says: "1000h declares {what}, but object {objects} is missing",
    help: "add {missing}, or clear bit {bit} of 1000h",
    check: Check::Device(check),
    ..Rule::NEW
};

/// A bit of 1000h, the process values of the block that it announces, and the name of the block.
const BLOCKS: [(u32, &[u16], &str); 2] = [
    (1, &[0x6130, 0x7130, 0x8130, 0x9130], "analogue inputs"),
    (3, &[0x6300, 0x7300, 0x8300, 0x9300], "analogue outputs"),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device(description, 404) else {
        return;
    };
    let blocks = BLOCKS.iter().filter(|(bit, _, _)| device.has(*bit));
    findings.extend(blocks.filter_map(|(bit, any_of, what)| {
        let finding = need(&W0903, description, any_of, what)?;
        Some(finding.fact("bit", bit + 16))
    }));
}
