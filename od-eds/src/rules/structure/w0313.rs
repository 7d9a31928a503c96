//! W0313: CompactSubObj is no number from 1 to 254.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0313",
    severity: Warning,
    title: "CompactSubObj is no number from 1 to 254",
    why: "CompactSubObj is the number of members besides sub-index 0. What cannot be a sub-index is left out.",
    source: "CiA 306-1, CompactSubObj",
    ..Rule::NEW
};
