//! W0905: profile object has another code or type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0905",
    severity: Warning,
    title: "profile object has another code or type",
    why: "A master that knows the object from the device profile reads and writes it with another length.",
    source: "CiA 401 and CiA 402, object overview",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
