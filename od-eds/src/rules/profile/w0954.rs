//! W0954: operating status differs from the operating parameters.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0954",
    severity: Warning,
    title: "operating status differs from the operating parameters",
    why: "6500h shows what is set in 6000h: code sequence, commissioning diagnosis, scaling.",
    source: "CiA 406, objects 6000h and 6500h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
