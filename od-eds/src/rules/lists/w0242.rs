//! W0242: list entries are not numbered 1, 2, 3.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0242",
    severity: Warning,
    title: "list entries are not numbered 1, 2, 3",
    why: "Many readers ask for entry 1, 2, 3 up to SupportedObjects, and miss an entry of another number. All entries are read.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
