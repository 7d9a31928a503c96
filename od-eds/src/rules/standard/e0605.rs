//! E0605: object 1001h is not as CiA 301 says.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0605",
    severity: Error,
    title: "object 1001h is not as CiA 301 says",
    why: "A VAR, UNSIGNED8, read only.",
    source: "CiA 301, object 1001h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
