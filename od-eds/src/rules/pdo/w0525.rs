//! W0525: mapping entry in use maps nothing.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0525",
    severity: Warning,
    title: "mapping entry in use maps nothing",
    why: "Sub-index 0 says how many objects are mapped, and each of these entries names one.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
