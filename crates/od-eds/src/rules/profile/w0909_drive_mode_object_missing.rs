use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0909: Rule = Rule {
    title: "drive lacks the object of a supported mode",
    why: "A master that chooses the mode finds no object to command the drive with, or to see what it does.",
    source: "CiA 402, object 6502h and modes of operation",
    says: "6502h declares {mode}, but object {object} ({name}) is missing",
    help: "add {missing}, or clear bit {bit} of 6502h",
    check: Check::Device(check),
    ..Rule::of("W0909")
};

/// A bit of 6502h, the mode, and an object that the mode must have.
const MODES: [(u32, &str, u16, &str); 21] = [
    (0, POSITION, 0x607A, "target position"),
    (0, POSITION, 0x6081, "profile velocity"),
    (0, POSITION, 0x6083, "profile acceleration"),
    (1, VL, 0x6042, "vl target velocity"),
    (1, VL, 0x6043, "vl velocity demand"),
    (1, VL, 0x6044, "vl velocity actual value"),
    (1, VL, 0x6046, "vl velocity min max amount"),
    (1, VL, 0x6048, "vl velocity acceleration"),
    (1, VL, 0x6049, "vl velocity deceleration"),
    (2, VELOCITY, 0x60FF, "target velocity"),
    (2, VELOCITY, 0x606C, "velocity actual value"),
    (3, "the profile torque mode", 0x6071, "target torque"),
    (5, "the homing mode", 0x6098, "homing method"),
    (5, "the homing mode", 0x6099, "homing speeds"),
    (6, INTERPOLATED, 0x60C1, "interpolation data record"),
    (7, CYCLIC_POSITION, 0x607A, "target position"),
    (7, CYCLIC_POSITION, 0x6064, "position actual value"),
    (8, CYCLIC_VELOCITY, 0x60FF, "target velocity"),
    (8, CYCLIC_VELOCITY, 0x606C, "velocity actual value"),
    (9, CYCLIC_TORQUE, 0x6071, "target torque"),
    (9, CYCLIC_TORQUE, 0x6077, "torque actual value"),
];

const POSITION: &str = "the profile position mode";
const VL: &str = "the velocity mode";
const VELOCITY: &str = "the profile velocity mode";
const INTERPOLATED: &str = "the interpolated position mode";
const CYCLIC_POSITION: &str = "the cyclic sync position mode";
const CYCLIC_VELOCITY: &str = "the cyclic sync velocity mode";
const CYCLIC_TORQUE: &str = "the cyclic sync torque mode";

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6502, 0);
    let modes = start_number(description, address).filter(|_| device(description, 402).is_some());
    let Some(modes) = modes else {
        return;
    };
    for (bit, mode, index, name) in MODES {
        if modes.value & 1 << bit != 0 && !description.objects.contains_key(&index) {
            let finding = W0909.at(modes.span).about(address).fact("mode", mode);
            let finding = finding
                .fact("object", Fact::Index(index))
                .fact("name", name);
            let missing = Fact::Section(index, None);
            findings.push(finding.fact("missing", missing).fact("bit", bit));
        }
    }
}
