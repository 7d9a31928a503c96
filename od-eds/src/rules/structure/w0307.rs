//! W0307: ARRAY or RECORD has no sub-index 0.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0307",
    severity: Warning,
    title: "ARRAY or RECORD has no sub-index 0",
    why: "A master reads sub-index 0 to learn how many members there are.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
