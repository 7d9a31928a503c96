use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0424",
    severity: Warning,
    title: "word instead of the value of CiA 306",
    why: "Types and object codes are numbers, PDOMapping is 0 or 1, and AccessType is one of six words. odkit reads what the word means; many EDS parsers reject it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as `{right}`",
    help: WRITE,
    ..Rule::NEW
};
