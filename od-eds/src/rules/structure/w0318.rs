//! W0318: key is nearly one of CiA 306.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0318",
    severity: Warning,
    title: "key is nearly one of CiA 306",
    why: "It looks like a slip. The key is kept, and nothing reads it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
