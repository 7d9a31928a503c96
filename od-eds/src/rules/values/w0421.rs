use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0421",
    severity: Warning,
    title: "BOOLEAN is neither 0 nor 1",
    why: "`true` and `false` are words of other formats. They are read as 1 and 0.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{given}` is read as a number",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
