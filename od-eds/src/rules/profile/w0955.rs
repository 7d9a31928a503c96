//! W0955: preset is outside the range.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0955",
    severity: Warning,
    title: "preset is outside the range",
    why: "6003h is a position, and positions go from 0 to one below 6002h.",
    source: "CiA 406, object 6003h",
    ..Rule::NEW
};
