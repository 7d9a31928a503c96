//! W0632: standard object has another access.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0632",
    severity: Warning,
    title: "standard object has another access",
    why: "What the standard has as read only is not to be written; what is written by masters must be writable.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
