use crate::finding::{Finding, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W1203",
    severity: Warning,
    title: "consumer without a producer",
    why: "A node waits for a message that no node of the network sends: an RPDO keeps its values, a heartbeat consumer reports an error.",
    source: "CiA 301, PDO, SYNC, TIME and heartbeat",
    example: "1016h:01 = 0x000503E8, without node 5",
    says: "{consumer} waits for {what}, which no node sends",
    help: "add the producer, or make the consumer not valid",
    ..Rule::NEW
};

/// The finding about a consumer.
pub(crate) fn finding(consumer: &str, what: &str) -> Finding {
    let finding = RULE.finding().fact("consumer", consumer);
    finding.fact("what", what)
}
