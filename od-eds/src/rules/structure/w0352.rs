//! W0352: SubNumber of an object without members.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0352",
    severity: Warning,
    title: "SubNumber of an object without members",
    why: "Only an ARRAY or a RECORD has sub-indices to count.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
