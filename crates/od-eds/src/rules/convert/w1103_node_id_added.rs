use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1103",
    severity: Warning,
    title: "CANopenNode adds the node ID to a fixed COB-ID",
    why: "CANopenNode takes a COB-ID of the pre-defined connection set without node ID for one that follows the node ID: a node with node ID 5 sends 185h where 1800h:01 is 180h. A master that expects the fixed COB-ID does not hear the node.",
    source: "CANopenNode 4, 301/CO_PDO.c, 301/CO_Emergency.c",
    example: "[1800sub1] DefaultValue=0x180",
    says: "CANopenNode adds the node ID to COB-ID {id:03X}h",
    help: "write `{DefaultValue=$NODEID+0x{id:X}}` if it follows the node ID, or another COB-ID",
    ..Rule::NEW
};

/// The finding about a COB-ID that is the pre-defined one without node ID.
pub(crate) fn finding(address: Address, value: Span, id: u32) -> Finding {
    let finding = RULE.at(value).about(address).key(Key::DefaultValue);
    finding.fact("id", i128::from(id))
}
