//! W0110: section header without name.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0110",
    severity: Warning,
    title: "section header without name",
    why: "No reader can ask for such a section. It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
