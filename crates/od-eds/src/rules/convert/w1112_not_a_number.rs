use crate::finding::{Finding, Rule, Severity::Warning};
use od_model::{Address, DataType};

pub(crate) static RULE: Rule = Rule {
    code: "W1112",
    severity: Warning,
    title: "DBC has only numbers",
    why: "A signal of a DBC is a number. odkit writes the bits of a string or DOMAIN as an unsigned number, lowest byte first.",
    source: "DBC file format, signals",
    example: "[1A00sub1] maps a VISIBLE_STRING",
    says: "the mapped {type} is written as an unsigned number",
    ..Rule::NEW
};

/// The finding about a mapped value that is not a number.
pub(crate) fn finding(mapped: Address, data_type: DataType) -> Finding {
    RULE.finding().about(mapped).fact("type", data_type)
}
