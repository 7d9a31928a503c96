//! W0951: encoder object has another access.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0951",
    severity: Warning,
    title: "encoder object has another access",
    why: "What CiA 406 has as read only is not to be written; what is written by masters must be writable.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
