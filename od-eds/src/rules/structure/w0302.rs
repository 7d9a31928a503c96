//! W0302: object with members has no ObjectType.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0302",
    severity: Warning,
    title: "object with members has no ObjectType",
    why: "Without ObjectType an object is a VAR, and this one has members. It is taken for a RECORD.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
