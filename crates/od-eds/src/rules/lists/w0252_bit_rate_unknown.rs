use crate::finding::{Finding, Rule, Severity};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0252",
    severity: Severity::Warning,
    title: "bit rate is not one of CiA 306",
    why: "A tool ignores the key and does not offer the bit rate. odkit keeps the key and ignores it.",
    source: "CiA 306-1, DeviceInfo; CiA 301, bit rates",
    says: "`{name}` is not a key of [DeviceInfo]",
    help: "write BaudRate_10, 20, 50, 125, 250, 500, 800 or 1000, or remove the line",
    ..Rule::NEW
};

/// Is this a key for a bit rate, whatever the rate?
pub(crate) fn is_rate(key: &str) -> bool {
    let start = key.get(.."BaudRate_".len());
    start.is_some_and(|start| start.eq_ignore_ascii_case("BaudRate_"))
}

/// The finding about the key of another bit rate.
pub(crate) fn finding(key: &Text<'_>) -> Finding {
    // Other tools do without it, too.
    RULE.at(key.span)
        .severity_of(Severity::Info)
        .fact("name", &*key.value)
}
