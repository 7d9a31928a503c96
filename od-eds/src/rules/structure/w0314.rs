//! W0314: compact section names a member that does not exist.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0314",
    severity: Warning,
    title: "compact section names a member that does not exist",
    why: "The entry is left out.",
    source: "CiA 306-1, CompactSubObj",
    mending: Mending::None,
    before: "\
        [2000Name]\n\
        NrOfEntries=1\n\
        4=Last",
    after: "\
        [2000Name]\n\
        NrOfEntries=1\n\
        3=Last",
};
