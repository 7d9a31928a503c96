//! W0317: SubNumber is missing.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0317",
    severity: Warning,
    title: "SubNumber is missing",
    why: "An object with members says how many. They are counted instead.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
