//! W0642: object without the one it belongs to.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0642",
    severity: Warning,
    title: "object without the one it belongs to",
    why: "Half of a service does nothing: each of the two is there for the other.",
    source: "CiA 301, objects 1005h to 1029h",
    ..Rule::NEW
};
