//! W0406: PDOMapping is neither 0 nor 1.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0406",
    severity: Warning,
    title: "PDOMapping is neither 0 nor 1",
    why: "0 is taken.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
