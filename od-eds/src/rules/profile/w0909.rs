use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::profile::shared::device;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W0909",
    severity: Warning,
    title: "drive lacks the object of a supported mode",
    why: "A master that chooses the mode finds no object to command the drive with.",
    source: "CiA 402, object 6502h and modes of operation",
    says: "6502h declares {mode}, but object {object} ({name}) is missing",
    help: "add {missing}, or clear bit {bit} of 6502h",
    check: Check::Device(check),
    ..Rule::NEW
};

/// A bit of 6502h, the mode, and the object that commands it.
const MODES: [(u32, &str, u16, &str); 10] = [
    (0, "the profile position mode", 0x607A, "target position"),
    (1, "the velocity mode", 0x6042, "vl target velocity"),
    (2, "the profile velocity mode", 0x60FF, "target velocity"),
    (3, "the profile torque mode", 0x6071, "target torque"),
    (5, "the homing mode", 0x6098, "homing method"),
    (5, "the homing mode", 0x6099, "homing speeds"),
    (
        6,
        "the interpolated position mode",
        0x60C1,
        "interpolation data record",
    ),
    (
        7,
        "the cyclic sync position mode",
        0x607A,
        "target position",
    ),
    (
        8,
        "the cyclic sync velocity mode",
        0x60FF,
        "target velocity",
    ),
    (9, "the cyclic sync torque mode", 0x6071, "target torque"),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6502, 0);
    let modes = start_number(description, address).filter(|_| device(description, 402).is_some());
    let Some(modes) = modes else {
        return;
    };
    for (bit, mode, index, name) in MODES {
        if modes.value & 1 << bit != 0 && !description.objects.contains_key(&index) {
            let finding = RULE.at(modes.span).about(address).fact("mode", mode);
            let finding = finding
                .fact("object", Fact::Index(index))
                .fact("name", name);
            let missing = Fact::Section(index, None);
            findings.push(finding.fact("missing", missing).fact("bit", bit));
        }
    }
}
