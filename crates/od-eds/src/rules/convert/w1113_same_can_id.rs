use crate::finding::{Finding, Rule, Severity::Warning};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1113",
    severity: Warning,
    title: "two messages of a node have one CAN-ID",
    why: "A DBC has one message for a CAN-ID. odkit keeps the first one in the order SYNC, TIME, EMCY, TPDO, RPDO, SDO, heartbeat.",
    source: "DBC file format, messages",
    example: "[1801sub1] DefaultValue=$NODEID+0x180",
    says: "another message has CAN-ID {id:03X}h",
    help: "write another COB-ID, or `--node-id` for the node ID of the device",
    ..Rule::NEW
};

/// The finding about a COB-ID.
pub(crate) fn finding(cob_id: Address, id: u32) -> Finding {
    let finding = RULE.finding().about(cob_id);
    finding.fact("id", i128::from(id))
}
