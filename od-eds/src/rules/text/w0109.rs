//! W0109: comment behind a value.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0109",
    severity: Warning,
    title: "comment behind a value",
    why: "A comment has a line of its own; behind a value it is part of the value. Where the value is a number, it is cut off.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
