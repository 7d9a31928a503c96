//! W0304: object or sub-index stands twice.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0304",
    severity: Warning,
    title: "object or sub-index stands twice",
    why: "The sections do not contradict each other; one is enough. What only one of them says counts.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
