use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0423",
    severity: Warning,
    title: "decimal comma",
    why: "It is read as a decimal point; many readers refuse it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read with a decimal point",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
