use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::subject::{start_number, start_value};
use od_model::Address;

pub(crate) static W0910: Rule = Rule {
    title: "drive starts in a mode that it does not support",
    why: "The drive does not move, or a master that reads 6502h does not expect the mode.",
    source: "CiA 402, objects 6060h and 6502h",
    says: "6060h is {mode}, but bit {bit} of 6502h is 0",
    help: "write a mode that 6502h declares, or set bit {bit} of 6502h",
    check: Check::Device(check),
    ..Rule::of("W0910")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6060, 0);
    let modes = start_number(description, Address::new(0x6502, 0));
    let mode = description.entry(address).and_then(start_value);
    if device(description, 402).is_none() {
        return;
    }
    if let Some((modes, mode)) = modes.zip(mode)
        && let Some(number @ 1..=10) = mode.integer(0)
        // 6502h = 0 gives no information about this mode.
        && modes.value != 0
        && modes.value & 1 << (number - 1) == 0
    {
        let finding = W0910.at(mode.span).about(address).fact("mode", number);
        let finding = finding.fact("bit", number - 1);
        findings.push(finding.related(modes.span, "supported modes"));
    }
}
