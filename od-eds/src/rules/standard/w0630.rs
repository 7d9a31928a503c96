//! W0630: standard object has another object code.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0630",
    severity: Warning,
    title: "standard object has another object code",
    why: "A master that knows the object from the standard reads sub-indices that do not exist, or misses those that do.",
    source: "CiA 301, chapter 7.5; CiA 302",
    ..Rule::NEW
};
