use crate::finding::{Finding, Rule, Severity::Error};

pub(crate) static RULE: Rule = Rule {
    code: "E1202",
    severity: Error,
    title: "two nodes send one CAN-ID",
    why: "Two frames with one CAN-ID that begin at the same time have a bit error, which no arbitration resolves; and no receiver can tell which node sent a frame.",
    source: "CiA 301, pre-defined connection set; ISO 11898-1",
    example: "TPDO 1 of two nodes has cob_id: 0x181",
    says: "{first} and {second} have CAN-ID {id:03X}h",
    help: "give one of them another COB-ID, or make it not valid",
    ..Rule::NEW
};

/// The finding about two senders.
pub(crate) fn finding(first: &str, second: &str, id: u32) -> Finding {
    let finding = RULE.finding().fact("first", first);
    finding.fact("second", second).fact("id", i128::from(id))
}
