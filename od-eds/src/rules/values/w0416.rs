//! W0416: limit is no value of its type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0416",
    severity: Warning,
    title: "limit is no value of its type",
    why: "A limit that the type cannot reach limits nothing. It is left out of the dictionary.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
