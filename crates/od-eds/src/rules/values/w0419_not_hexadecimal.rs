use crate::finding::{Fixability, Rule, Severity::Warning};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "W0419",
    severity: Warning,
    title: "byte string is not hexadecimal",
    why: "An OCTET_STRING or a DOMAIN is written as hexadecimal bytes. odkit uses the codes of the characters.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{given}` is not a string of hexadecimal bytes",
    help: WRITE,
    ..Rule::NEW
};
