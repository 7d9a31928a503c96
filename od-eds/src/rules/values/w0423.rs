//! W0423: decimal comma.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0423",
    severity: Warning,
    title: "decimal comma",
    why: "It is read as a decimal point; many readers refuse it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
