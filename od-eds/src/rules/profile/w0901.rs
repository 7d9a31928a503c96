//! W0901: I/O module lacks what it says it has.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0901",
    severity: Warning,
    title: "I/O module lacks what it says it has",
    why: "1000h of a CiA 401 device says which kinds of channels it has; each has its objects.",
    source: "CiA 401, object 1000h",
    ..Rule::NEW
};
