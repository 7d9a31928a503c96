//! E0405: AccessType is none.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0405",
    severity: Error,
    title: "AccessType is none",
    why: "AccessType is ro, wo, rw, rwr, rww or const. `ro` is taken.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
