//! W0321: NrOfEntries does not count its section.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0321",
    severity: Warning,
    title: "NrOfEntries does not count its section",
    why: "Many readers read as many entries as it says and no more. All entries are read.",
    source: "CiA 306-1, CompactSubObj",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
