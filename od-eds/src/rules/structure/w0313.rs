//! W0313: CompactSubObj is no number from 1 to 254.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0313",
    severity: Warning,
    title: "CompactSubObj is no number from 1 to 254",
    why: "CompactSubObj is the number of members besides sub-index 0. What cannot be a sub-index is left out.",
    source: "CiA 306-1, CompactSubObj",
    mending: Mending::None,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        PDOMapping=0\n\
        CompactSubObj=300",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        PDOMapping=0\n\
        CompactSubObj=3",
};
