//! W0950: encoder object has another code or type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0950",
    severity: Warning,
    title: "encoder object has another code or type",
    why: "A master that knows the object from CiA 406 reads and writes it with another length.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
