use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};

pub(crate) static I0240: Rule = Rule {
    severity: Warning,
    title: "[FileInfo] or [DeviceInfo] is missing",
    why: "A tool reads there what the file is and which device it describes.",
    source: "CiA 306-1, FileInfo and DeviceInfo",
    says: "section [{section}] is missing",
    help: "add a section [{section}]",
    check: Check::Device(check),
    ..Rule::of("I0240")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for name in ["FileInfo", "DeviceInfo"] {
        if !description.objects.is_empty() && description.section(name).is_none() {
            findings.push(I0240.finding().fact("section", name));
        }
    }
}
