use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0420",
    severity: Warning,
    title: "number has a suffix or a decimal point",
    why: "`0x10L` and `5.0` are how other languages write integers. odkit reads the integer; many EDS parsers reject it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as an integer",
    help: WRITE,
    ..Rule::NEW
};
