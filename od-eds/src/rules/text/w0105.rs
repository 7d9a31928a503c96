//! W0105: key before the first section.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0105",
    severity: Warning,
    title: "key before the first section",
    why: "A key belongs to a section. It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
