use crate::finding::{Fixability, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0419",
    severity: Warning,
    title: "byte string is not hexadecimal",
    why: "An OCTET_STRING or a DOMAIN is written as hexadecimal bytes. The characters are taken for the bytes.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{given}` is no string of hexadecimal bytes",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
