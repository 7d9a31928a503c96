//! W0407: ObjFlags is no number.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0407",
    severity: Warning,
    title: "ObjFlags is no number",
    why: "0 is taken.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
