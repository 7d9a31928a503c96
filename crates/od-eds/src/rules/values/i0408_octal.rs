use crate::finding::{Fixability, Rule, Severity::Info};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "I0408",
    severity: Info,
    title: "number with a leading 0 is octal",
    why: "`010` is 8 in C and in odkit, but 10 in some tools.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as octal",
    help: WRITE,
    ..Rule::NEW
};
