//! W0209: compact section without CompactSubObj.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0209",
    severity: Warning,
    title: "compact section without CompactSubObj",
    why: "[xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. The section is kept, and nothing reads it.",
    source: "CiA 306-1, CompactSubObj",
    ..Rule::NEW
};
