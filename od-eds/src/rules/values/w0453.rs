//! W0453: constant has no value.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0453",
    severity: Warning,
    title: "constant has no value",
    why: "What is const never changes; without a DefaultValue nobody knows what it is. 0 is taken.",
    source: "CiA 306-1, AccessType",
    ..Rule::NEW
};
