//! W0204: SupportedObjects does not count its list.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0204",
    severity: Warning,
    title: "SupportedObjects does not count its list",
    why: "Many readers read as many entries as it says and no more. All entries are read.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
