//! W0351: ARRAY has a gap.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0351",
    severity: Warning,
    title: "ARRAY has a gap",
    why: "The members of an ARRAY have the sub-indices 1, 2, 3 and so on; a master that walks through it gets an abort at the gap.",
    source: "CiA 301, object codes",
    ..Rule::NEW
};
