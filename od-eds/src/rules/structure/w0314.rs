//! W0314: compact section names a member that does not exist.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0314",
    severity: Warning,
    title: "compact section names a member that does not exist",
    why: "The entry is left out.",
    source: "CiA 306-1, CompactSubObj",
    ..Rule::NEW
};
