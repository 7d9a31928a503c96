use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::subject::{Object, shown, start_value};
use od_model::Address;

pub(crate) static W0540: Rule = Rule {
    title: "SDO has only one valid COB-ID",
    why: "An SDO exists only if both COB-IDs are valid: the device sends no request, or no response.",
    source: "CiA 301, SDO server parameter and SDO client parameter",
    says: "COB-ID {object} is valid, but {other} is not valid (bit 31)",
    help: "write a valid COB-ID to {other}, or set bit 31 of {object} (`0x80000000`)",
    check: Check::Object(check),
    ..Rule::of("W0540")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !matches!(object.index, 0x1201..=0x12FF) {
        return;
    }
    let at = |sub| object.object.entries.get(&sub).and_then(start_value);
    let Some((first, second)) = at(1).zip(at(2)) else {
        return;
    };
    let bits = |node_id| Some((first.integer(node_id)?, second.integer(node_id)?));
    let Some((request, response)) = bits(1) else {
        return;
    };
    let (valid, other, place) = match (request >> 31 & 1, response >> 31 & 1) {
        (0, 1) => (1, 2, first),
        (1, 0) => (2, 1, second),
        _ => return,
    };
    let address = |sub| Address::new(object.index, sub);
    let finding = W0540.on(object, place.span).about(address(valid));
    let finding = finding.fact("object", shown(object, address(valid)));
    findings.push(finding.fact("other", shown(object, address(other))));
}
