//! W0101: line is no section, no key and no comment.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0101",
    severity: Warning,
    title: "line is no section, no key and no comment",
    why: "Most readers stop at such a line. It is ignored here.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
