//! W0952: range is not the units of all revolutions.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0952",
    severity: Warning,
    title: "range is not the units of all revolutions",
    why: "6002h is 6001h times the revolutions, or divides that; else the position jumps where the encoder starts again.",
    source: "CiA 406, objects 6001h and 6002h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
