//! W0106: section stands twice.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0106",
    severity: Warning,
    title: "section stands twice",
    why: "Readers differ in which one they take. The first counts; both are kept.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
