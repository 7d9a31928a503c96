use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0423",
    severity: Warning,
    title: "decimal comma",
    why: "odkit reads the comma as a decimal point; many EDS parsers reject it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` with a decimal point",
    help: WRITE,
    ..Rule::NEW
};
