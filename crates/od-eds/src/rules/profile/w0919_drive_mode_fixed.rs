use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::device;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0919: Rule = Rule {
    code: "W0919",
    severity: Warning,
    title: "mode of a drive with several modes is fixed",
    why: "A master selects the mode by writing 6060h. The drive refuses it, so its other modes are never used.",
    source: "CiA 402, objects 6060h and 6502h",
    says: "6502h declares {count} modes, but 6060h cannot be written",
    help: "change {AccessType} to `rw`, or declare one mode in 6502h",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6060, 0);
    let Some(modes) = start_number(description, Address::new(0x6502, 0)) else {
        return;
    };
    // Bits 0 to 10 are the modes of the profile.
    let count = (modes.value & 0x7FF).count_ones();
    if let Some(entry) = description.entry(address)
        && device(description, 402).is_some()
        && count > 1
        && !entry.access.writable()
    {
        let finding = W0919.at(entry.access.span).about(address);
        let finding = finding.fact("count", count);
        findings.push(finding.related(modes.span, "supported modes"));
    }
}
