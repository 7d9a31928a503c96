use crate::finding::{Finding, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W1205",
    severity: Warning,
    title: "bus load is too high",
    why: "The periodic frames, with all stuff bits, take more than 80 % of the time: frames of low priority come late, and from 100 % on some never come.",
    source: "ISO 11898-1, frame format",
    example: "50 TPDOs of 8 bytes every 10 ms at 250 kbit/s",
    says: "periodic frames take up to {percent} % of {rate} kbit/s",
    help: "send them less often, or use a higher bit rate",
    ..Rule::NEW
};

/// The finding about the bus load in percent.
pub(crate) fn finding(load: f64, rate: u32) -> Finding {
    let finding = RULE.finding().fact("percent", load as i128);
    finding.fact("rate", i128::from(rate))
}
