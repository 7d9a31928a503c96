//! W0311: sub-index 0 is lower than the highest member.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0311",
    severity: Warning,
    title: "sub-index 0 is lower than the highest member",
    why: "A master that reads up to sub-index 0 never sees the members above it.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
