//! E0415: LowLimit is greater than HighLimit.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0415",
    severity: Error,
    title: "LowLimit is greater than HighLimit",
    why: "No value lies between them.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
