use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::standard::shared::consumers;
use crate::subject::Object;

pub(crate) static E0650: Rule = Rule {
    code: "E0650",
    severity: Error,
    buildable: true,
    title: "heartbeat consumer watches a node twice",
    why: "CiA 301 allows one entry for each node. The device aborts the download of the second entry.",
    source: "CiA 301, object 1016h",
    says: "node {node} has a heartbeat time in an entry before",
    help: "write 0, or the node ID of another node in bits 16 to 23",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let mut known = BTreeMap::new();
    for (entry, span, node) in consumers(object).filter(|(_, _, node)| (1..=127).contains(node)) {
        match known.get(&node) {
            None => drop(known.insert(node, span)),
            Some(first) => {
                let finding = E0650.on(&entry, span).fact("node", node);
                findings.push(finding.related(*first, "first time of this node"));
            }
        }
    }
}
