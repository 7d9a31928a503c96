use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};

pub(crate) static E0210: Rule = Rule {
    title: "file defines no object",
    why: "The file is empty, or it is not an EDS or a DCF. No device can be built.",
    source: "CiA 306-1",
    says: "the file defines no object",
    help: "add a section for each object, such as [1000]",
    check: Check::Device(check),
    ..Rule::of("E0210")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    if description.objects.is_empty() {
        findings.push(E0210.finding());
    }
}
