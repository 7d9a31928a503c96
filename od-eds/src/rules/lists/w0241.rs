//! W0241: Lines does not count [Comments].

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0241",
    severity: Warning,
    title: "Lines does not count [Comments]",
    why: "A tool that trusts Lines shows too few comments, or stops at a missing one.",
    source: "CiA 306-1, Comments",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
