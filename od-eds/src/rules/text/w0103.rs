//! W0103: section header has no closing bracket.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0103",
    severity: Warning,
    title: "section header has no closing bracket",
    why: "Most readers stop at such a line. The header is taken to end with its line.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
