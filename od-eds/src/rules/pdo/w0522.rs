use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::cob_ids::{CobId, cob_ids};

pub(crate) static RULE: Rule = Rule {
    code: "W0522",
    severity: Error,
    buildable: true,
    title: "CAN-ID is too long for an 11-bit COB-ID",
    why: "Bit 29 of a COB-ID marks a CAN-ID of 29 bits; without it, bits 11 to 28 must be 0.",
    source: "CiA 301, COB-ID",
    says: "CAN-ID `0x{id:X}` has more than 11 bits, but bit 29 is 0",
    help: "write a CAN-ID up to `0x7FF`, or set bit 29 (`0x20000000`)",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description).filter(CobId::is_too_long) {
        findings.push(cob_id.finding(&RULE).fact("id", cob_id.identifier));
    }
}
