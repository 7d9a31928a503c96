use crate::finding::{Fixability, Rule, Severity::Info};

pub(crate) static RULE: Rule = Rule {
    code: "I0408",
    severity: Info,
    title: "number with a leading 0 is octal",
    why: "`010` is 8. It is read so, as C reads it; not every reader does.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "`{given}` is read as octal",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
