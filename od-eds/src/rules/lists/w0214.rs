//! W0214: number of a list stands twice.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0214",
    severity: Warning,
    title: "number of a list stands twice",
    why: "Readers that ask for each number miss one of the two. Both entries are read.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
