use crate::finding::{Finding, Rule, Severity::Error};

pub(crate) static RULE: Rule = Rule {
    code: "E1201",
    severity: Error,
    title: "two nodes have one node ID",
    why: "Both nodes answer each SDO request, and send with the same CAN-IDs: the bus reports bit errors, and the master cannot tell them apart.",
    source: "CiA 301, node ID",
    example: "two nodes with node_id: 5",
    says: "{first} and {second} have node ID {id}",
    help: "give each node a node ID of its own, from 1 to 127",
    ..Rule::NEW
};

/// The finding about two nodes.
pub(crate) fn finding(first: &str, second: &str, id: u8) -> Finding {
    let finding = RULE.finding().fact("first", first);
    finding.fact("second", second).fact("id", i128::from(id))
}
