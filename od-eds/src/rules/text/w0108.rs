//! W0108: `:` instead of `=`.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0108",
    severity: Warning,
    title: "`:` instead of `=`",
    why: "Only some readers know it. It is read as `=`.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
