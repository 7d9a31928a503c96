use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0421",
    severity: Warning,
    title: "BOOLEAN is neither 0 nor 1",
    why: "`true` and `false` are words of other formats. odkit reads them as 1 and 0; many EDS parsers reject them.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as a number",
    help: WRITE,
    ..Rule::NEW
};
