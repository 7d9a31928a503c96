use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::{IO_BLOCKS, device, need};

pub(crate) static W0901: Rule = Rule {
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

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device(description, 401) else {
        return;
    };
    let blocks = IO_BLOCKS.iter().filter(|(bit, _, _)| device.has(*bit));
    findings.extend(blocks.filter_map(|(bit, any_of, what)| {
        let finding = need(&W0901, description, any_of, what)?;
        Some(finding.fact("bit", bit + 16))
    }));
}
