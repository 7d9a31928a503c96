use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity};
use crate::rules::pdo::cob_ids::{CobId, cob_ids};

pub(crate) static W0521: Rule = Rule {
    severity: Severity::Error,
    title: "two PDOs have the same COB-ID",
    why: "A receiver cannot tell two PDOs with the same COB-ID apart.",
    source: "CiA 301, PDO communication parameter",
    says: "{object} repeats the COB-ID of {first}",
    help: "write {right}{fix}, or set bit 31 (`0x80000000`) to make the PDO not valid",
    also: &[ONE],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0521")
};

/// Sentence for a number and a COB-ID with the node ID that are equal for one node ID.
const ONE: Form = Form {
    says: "{object} has the CAN-ID of {first}, {can:03X}h, at node ID {node}",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let all: Vec<CobId<'_>> = cob_ids(description).collect();
    let pdos: Vec<&CobId<'_>> = all.iter().filter(|cob_id| cob_id.is_pdo()).collect();
    for (at, cob_id) in pdos.iter().enumerate() {
        let before = pdos[..at].iter();
        let mut met = before.filter_map(|first| Some((first, cob_id.meets(first)?)));
        let same = met.clone().find(|(first, _)| cob_id.is_same(first));
        if let Some((first, node)) = same.or_else(|| met.next()) {
            let finding = cob_id.finding(&W0521).fact("object", cob_id.entry.address);
            let finding = finding.fact("first", first.entry.address);
            let finding = if same.is_some() {
                finding
            } else {
                finding
                    .form(&ONE)
                    .fact("can", cob_id.can_id(node))
                    .fact("node", node)
            };
            // A node does not receive its own frames: only its partner is wrong.
            let finding = if first.service == cob_id.service {
                finding
            } else {
                finding.severity_of(Severity::Warning)
            };
            let finding = finding.related(first.span, "first used here");
            findings.push(cob_id.with_default(finding, &all));
        }
    }
}
