use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1102",
    severity: Warning,
    title: "CANopenNode does not add the node ID to the value",
    why: "CANopenNode adds the node ID to the COB-IDs of the pre-defined connection set: 1014h, 1200h, 1400h to 1403h and 1800h to 1803h. Every other value of OD.c is the same for all node IDs; odkit writes it without the node ID.",
    source: "CANopenNode 4, 301/CO_PDO.c, 301/CO_Emergency.c, 301/CO_SDOserver.c",
    example: "[2100] DefaultValue=$NODEID+0x10",
    says: "{DefaultValue} depends on the node ID, and CANopenNode does not add it here",
    help: "add `--node-id 5` to write the value of one node",
    ..Rule::NEW
};

/// The finding about a default with `$NODEID`.
pub(crate) fn finding(address: Address, value: Span) -> Finding {
    RULE.at(value).about(address).key(Key::DefaultValue)
}
