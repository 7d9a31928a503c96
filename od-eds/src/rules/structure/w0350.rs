//! W0350: sub-index 0 is higher than the highest member.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0350",
    severity: Warning,
    title: "sub-index 0 is higher than the highest member",
    why: "A master that reads up to sub-index 0 gets an abort for what does not exist.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
