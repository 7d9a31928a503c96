//! W0107: key stands twice in its section.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0107",
    severity: Warning,
    title: "key stands twice in its section",
    why: "Readers differ in which one they take. The first counts.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Either,
    ..Rule::NEW
};
