//! E0604: object 1000h is not as CiA 301 says.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0604",
    severity: Error,
    title: "object 1000h is not as CiA 301 says",
    why: "A VAR, UNSIGNED32, read only.",
    source: "CiA 301, object 1000h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
