//! W0102: line has no key before the `=`.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0102",
    severity: Warning,
    title: "line has no key before the `=`",
    why: "Nothing can ask for a value without a key. The line is ignored.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
