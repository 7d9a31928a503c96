use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::standard::shared::consumers;
use crate::subject::Object;

pub(crate) static W0651: Rule = Rule {
    code: "W0651",
    severity: Warning,
    title: "heartbeat consumer watches a node that cannot exist",
    why: "The device ignores the entry, so it watches no node. Bits 16 to 23 are the node ID, 1 to 127, bits 0 to 15 the time.",
    source: "CiA 301, object 1016h",
    says: "node ID {node} is not valid, but the entry has a heartbeat time",
    help: "write a node ID from 1 to 127 in bits 16 to 23, or 0 for no entry",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let wrong = consumers(object).filter(|(_, _, node)| !(1..=127).contains(node));
    findings.extend(wrong.map(|(entry, span, node)| W0651.on(&entry, span).fact("node", node)));
}
