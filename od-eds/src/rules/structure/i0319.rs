//! I0319: key is none of CiA 306.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0319",
    severity: Info,
    title: "key is none of CiA 306",
    why: "It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
