use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::pdo::cob_ids::{CobId, cob_ids};

pub(crate) static RULE: Rule = Rule {
    code: "W0521",
    severity: Warning,
    title: "two PDOs have one COB-ID",
    why: "Two PDOs of one device on one identifier cannot be told apart.",
    source: "CiA 301, PDO communication parameter",
    says: "{object} has the COB-ID of {first}",
    help: "write another COB-ID, or set bit 31 (0x80000000) for a PDO that is not used",
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
                let finding = cob_id.finding(&RULE).fact("object", Fact::Index(index));
                let finding = finding.fact("first", Fact::Index(*first));
                findings.push(finding.related(*span, "it is used here"));
            }
        }
    }
}
