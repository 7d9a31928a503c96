use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0420",
    severity: Warning,
    title: "number has a suffix or a decimal point",
    why: "`0x10L` and `5.0` are how other languages write integers. The integer is taken; many readers refuse it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read as an integer",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
