use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0422",
    severity: Warning,
    title: "hexadecimal number without `0x`",
    why: "`FF` and `1Fh` are how other formats write 0xFF and 0x1F. odkit reads them so; many EDS parsers reject them.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as hexadecimal",
    help: WRITE,
    ..Rule::NEW
};
