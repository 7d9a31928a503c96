//! W0322: sub-index is no VAR.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0322",
    severity: Warning,
    title: "sub-index is no VAR",
    why: "The object code of a sub-index is VAR, or DOMAIN. It is taken for a VAR.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
