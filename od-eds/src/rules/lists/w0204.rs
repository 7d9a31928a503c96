//! W0204: SupportedObjects does not count its list.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0204",
    severity: Warning,
    title: "SupportedObjects does not count its list",
    why: "Many readers read as many entries as it says and no more. All entries are read.",
    source: "CiA 306-1, object lists",
    mending: Mending::Safe,
    before: "\
        [ManufacturerObjects]\n\
        SupportedObjects=3\n\
        1=0x2000",
    after: "\
        [ManufacturerObjects]\n\
        SupportedObjects=1\n\
        1=0x2000",
};
