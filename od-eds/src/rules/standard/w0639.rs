//! W0639: error history of a new device is not empty.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0639",
    severity: Warning,
    title: "error history of a new device is not empty",
    why: "Sub-index 0 of 1003h counts the errors that there are, not the room for them.",
    source: "CiA 301, object 1003h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
