//! W0213: section name is nearly one of CiA 306.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0213",
    severity: Warning,
    title: "section name is nearly one of CiA 306",
    why: "It looks like a slip. The section is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
