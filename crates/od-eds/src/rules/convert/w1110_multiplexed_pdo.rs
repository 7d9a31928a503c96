use crate::finding::{Finding, Rule, Severity::Warning};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1110",
    severity: Warning,
    title: "DBC cannot describe a multiplexed PDO",
    why: "The frames of a multiplexed PDO name the object that they carry (CiA 301, MPDO), so it has no signals. odkit leaves the message out.",
    source: "CiA 301, multiplexed PDO",
    example: "[1A00sub0] DefaultValue=255",
    says: "DBC cannot describe a multiplexed PDO",
    ..Rule::NEW
};

/// The finding about the number of mapped objects.
pub(crate) fn finding(mapping: Address) -> Finding {
    RULE.finding().about(mapping)
}
