//! W0203: file has no object lists.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0203",
    severity: Warning,
    title: "file has no object lists",
    why: "A reader that follows the lists sees no objects. Every section is taken for an object.",
    source: "CiA 306-1, object lists",
    ..Rule::NEW
};
