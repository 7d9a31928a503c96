use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0409",
    severity: Warning,
    title: "number with a leading 0 is not octal",
    why: "`08` is no octal number. It is read as decimal; many readers refuse it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read as decimal",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
