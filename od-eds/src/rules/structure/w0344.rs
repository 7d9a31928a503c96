//! W0344: name is longer than 241 characters.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0344",
    severity: Warning,
    title: "name is longer than 241 characters",
    why: "CiA 306 lets names have 241 characters; some readers cut what is longer.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
