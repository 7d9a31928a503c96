use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::cob_ids::{CobId, cob_ids};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W0521",
    severity: Error,
    buildable: true,
    title: "two PDOs have the same COB-ID",
    why: "A receiver cannot tell two PDOs with the same COB-ID apart.",
    source: "CiA 301, PDO communication parameter",
    says: "{object} repeats the COB-ID of {first}",
    help: "write another COB-ID, or set bit 31 (`0x80000000`) to make the PDO not valid",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut used = BTreeMap::new();
    for cob_id in cob_ids(description).filter(CobId::is_pdo) {
        let index = cob_id.entry.address.index;
        match used.get(&(cob_id.formula, cob_id.identifier)) {
            None => {
                used.insert((cob_id.formula, cob_id.identifier), (index, cob_id.span));
            }
            Some((first, span)) => {
                let finding = cob_id.finding(&RULE).fact("object", Address::new(index, 1));
                let finding = finding.fact("first", Address::new(*first, 1));
                findings.push(finding.related(*span, "first used here"));
            }
        }
    }
}
