//! W0631: standard object has another type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0631",
    severity: Warning,
    title: "standard object has another type",
    why: "A master that knows the object from the standard reads and writes it with another length.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
