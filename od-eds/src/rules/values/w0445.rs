//! W0445: rwr or rww, but not mappable.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0445",
    severity: Warning,
    title: "rwr or rww, but not mappable",
    why: "rwr and rww say into which PDO an object may be mapped; of an object that is not mappable they say nothing.",
    source: "CiA 306-1, AccessType",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
