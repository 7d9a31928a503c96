use crate::finding::{Finding, Rule, Severity::Info};

pub(crate) static RULE: Rule = Rule {
    code: "I1106",
    severity: Info,
    title: "CANopenNode does not check limits",
    why: "OD.c has no LowLimit and no HighLimit: the node accepts each value that a master writes. The application checks it in the `write` function of an extension.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_extension_t",
    example: "[2100] LowLimit=1",
    says: "the node does not check the limits of {count:value|values}",
    help: "check them in the `write` function of an `OD_extension_t`",
    ..Rule::NEW
};

/// The finding about all limits.
pub(crate) fn finding(count: usize) -> Finding {
    RULE.finding().fact("count", count as i128)
}
