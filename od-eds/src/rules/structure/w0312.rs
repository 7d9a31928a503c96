//! W0312: members of an ARRAY differ in type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0312",
    severity: Warning,
    title: "members of an ARRAY differ in type",
    why: "The members of an ARRAY are all of one type; those of a RECORD may differ.",
    source: "CiA 301, object codes",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
