//! W0321: NrOfEntries does not count its section.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0321",
    severity: Warning,
    title: "NrOfEntries does not count its section",
    why: "Many readers read as many entries as it says and no more. All entries are read.",
    source: "CiA 306-1, CompactSubObj",
    mending: Mending::Safe,
    before: "\
        [2000Value]\n\
        NrOfEntries=1\n\
        1=7",
    after: "\
        [2000Value]\n\
        NrOfEntries=2\n\
        1=7",
};
