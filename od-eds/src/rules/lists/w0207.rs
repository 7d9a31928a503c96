//! W0207: object is listed twice.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0207",
    severity: Warning,
    title: "object is listed twice",
    why: "One entry is enough; some editors make two objects of two.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
