//! W0323: Count of a module is none.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0323",
    severity: Warning,
    title: "Count of a module is none",
    why: "Count says how many sub-indices a module adds: a number, or `0;` and the bits that share one. One is taken.",
    source: "CiA 306-1, modular devices",
    ..Rule::NEW
};
