//! W0202: object is in no list.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0202",
    severity: Warning,
    title: "object is in no list",
    why: "A reader that follows the lists does not see the object. It is taken to exist.",
    source: "CiA 306-1, object lists",
    ..Rule::NEW
};
