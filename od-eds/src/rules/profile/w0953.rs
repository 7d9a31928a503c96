//! W0953: position is not mappable.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0953",
    severity: Warning,
    title: "position is not mappable",
    why: "The position is what an encoder sends in its PDOs.",
    source: "CiA 406, object 6004h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
