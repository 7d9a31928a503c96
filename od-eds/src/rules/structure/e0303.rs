//! E0303: object or sub-index stands twice with different content.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0303",
    severity: Error,
    title: "object or sub-index stands twice with different content",
    why: "Two sections for one object contradict each other; readers differ in which one they take. The first counts, with what only the other says.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
