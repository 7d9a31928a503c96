//! W0511: transmission type is reserved.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0511",
    severity: Warning,
    title: "transmission type is reserved",
    why: "0–240 and 252–255 have a meaning, for an RPDO 0–240, 254 and 255.",
    source: "CiA 301, PDO communication parameter",
    ..Rule::NEW
};
