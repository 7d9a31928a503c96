use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0409",
    severity: Warning,
    title: "number with a leading 0 is not octal",
    why: "`08` is not a valid octal number. odkit reads it as decimal; many EDS parsers reject it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as decimal",
    help: WRITE,
    ..Rule::NEW
};
