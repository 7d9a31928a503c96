use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::transmission_type;
use crate::rules::values::shared::Reserved;
use crate::subject::{Object, start_value};
use od_model::Address;

pub(crate) static W0534: Rule = Rule {
    title: "RTR-only TPDO does not allow RTR",
    why: "A master never gets the TPDO: the device sends it only on a remote frame, but bit 30 of its COB-ID forbids remote frames.",
    source: "CiA 301, PDO communication parameter",
    fixability: Fixability::Unsafe,
    says: "transmission type {given} is RTR-only, but bit 30 of the COB-ID does not allow RTR",
    help: "clear bit 30 of sub-index 1{fix}, or write 254 or 255",
    check: Check::Object(check),
    ..Rule::of("W0534")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let cob_id = object.object.entries.get(&1).and_then(start_value);
    if let Some(given) = transmission_type(object).filter(|given| given.value.is_rtr_only())
        && object.index >= 0x1800
        && let Some(cob_id) = cob_id
        && cob_id
            .integer(0)
            .is_some_and(|id| id & 1 << 30 != 0 && id & 1 << 31 == 0)
    {
        let finding = W0534
            .on(object, given.span)
            .about(Address::new(object.index, 2))
            .fact("given", given.value.raw());
        let finding = finding.related(cob_id.span, "bit 30 is set here");
        findings.push(match Reserved::Bits(1 << 30).cleared(&cob_id.value) {
            Some(right) => finding.fix(Fix::unsafe_fix().replace(cob_id.span, right)),
            None => finding,
        });
    }
}
