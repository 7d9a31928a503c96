use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity::Error};
use crate::rules::pdo::cob_ids::{CobId, cob_ids};

pub(crate) static W0522: Rule = Rule {
    severity: Error,
    title: "CAN-ID is too long for its COB-ID",
    why: "Bit 29 of a COB-ID marks a CAN-ID of 29 bits; without it, bits 11 to 28 must be 0. Many nodes drop the upper bits: 800h becomes 000h, an NMT command.",
    source: "CiA 301, COB-ID",
    says: "CAN-ID `0x{id:X}` has more than 11 bits, but bit 29 is 0",
    help: "write {right}{fix}, or set bit 29 (`0x20000000`) for a CAN-ID above `0x7FF`",
    also: &[SOME],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0522")
};

/// Sentence for a CAN-ID that is too long with the node ID added.
const SOME: Form = Form {
    says: "the CAN-ID of node ID {node} is {can:X}h, which has more than {bits} bits; cut off, it is {cut:03X}h",
    help: "write {right}{fix}, so that the CAN-ID of node IDs 1 to 127 fits into {bits} bits",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let all: Vec<CobId<'_>> = cob_ids(description).collect();
    for cob_id in &all {
        let found = cob_id.too_long().map(|node| finding(cob_id, node));
        findings.extend(found.map(|found| cob_id.with_default(found, &all)));
    }
}

fn finding(cob_id: &CobId<'_>, node: u8) -> Finding {
    let finding = cob_id.finding(&W0522);
    // Too long whatever the node ID is.
    if !cob_id.extended && cob_id.identifier > 0x7FF {
        return finding.fact("id", cob_id.identifier);
    }
    let bits = if cob_id.extended { 29_u8 } else { 11 };
    let can_id = cob_id.can_id(node);
    let finding = finding.form(&SOME).fact("node", node).fact("bits", bits);
    finding
        .fact("can", can_id)
        .fact("cut", can_id & ((1 << bits) - 1))
}
