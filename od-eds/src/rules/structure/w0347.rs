//! W0347: sub-index 0 of a standard object can be written.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0347",
    severity: Warning,
    title: "sub-index 0 of a standard object can be written",
    why: "Sub-index 0 counts the members, which no master changes; 1003h and the mappings are the exception.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
