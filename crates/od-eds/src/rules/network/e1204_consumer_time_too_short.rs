use crate::finding::{Finding, Rule, Severity::Error};

pub(crate) static RULE: Rule = Rule {
    code: "E1204",
    severity: Error,
    title: "heartbeat consumer time is too short",
    why: "The consumer time is not longer than the time between two heartbeats, so the consumer reports an error although the producer works.",
    source: "CiA 301, consumer heartbeat time (1016h)",
    example: "1016h:01 = 0x00050064 for a node 5 with 1017h = 100",
    says: "{consumer} waits {time} ms for the heartbeat of {producer}, which comes every {period} ms",
    help: "write at least 1.5 times the producer heartbeat time to 1016h",
    ..Rule::NEW
};

/// The finding about a consumer and its producer.
pub(crate) fn finding(consumer: &str, time: u32, producer: &str, period: u32) -> Finding {
    let finding = RULE.finding().fact("consumer", consumer);
    let finding = finding
        .fact("time", i128::from(time))
        .fact("producer", producer);
    finding.fact("period", i128::from(period))
}
