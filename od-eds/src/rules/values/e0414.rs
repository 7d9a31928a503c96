//! E0414: value is outside its limits.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0414",
    severity: Error,
    title: "value is outside its limits",
    why: "A device refuses to be set to what its own default is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    ..Rule::NEW
};
