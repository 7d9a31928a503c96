//! W0104: text behind a section header.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0104",
    severity: Warning,
    title: "text behind a section header",
    why: "Most readers stop at such a line. The text is ignored.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
