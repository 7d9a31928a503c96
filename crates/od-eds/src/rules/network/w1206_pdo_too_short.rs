use crate::finding::{Finding, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W1206",
    severity: Warning,
    title: "PDO is shorter than its consumer maps",
    why: "A node does not process a PDO that is shorter than its mapping, and sends EMCY 8210h.",
    source: "CiA 301, PDO length and EMCY error code 8210h",
    example: "TPDO 1 with 2 bytes, received by an RPDO with 4",
    says: "{consumer} maps {mapped:byte|bytes}, but {producer} sends {sent:byte|bytes}",
    help: "map as many bytes as the producer sends, or map more objects in the producer",
    ..Rule::NEW
};

/// The finding about a PDO and its consumer.
pub(crate) fn finding(consumer: &str, mapped: u32, producer: &str, sent: u32) -> Finding {
    let finding = RULE
        .finding()
        .fact("consumer", consumer)
        .fact("producer", producer);
    let finding = finding.fact("mapped", i128::from(mapped));
    finding.fact("sent", i128::from(sent))
}
