//! W0244: NrOfEntries does not count its list.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0244",
    severity: Warning,
    title: "NrOfEntries does not count its list",
    why: "A configuration tool reads as many entries as it says and no more.",
    source: "CiA 306-1, SupportedModules",
    mending: Mending::Safe,
    before: "\
        [M1FixedObjects]\n\
        NrOfEntries=4\n\
        1=0x6000",
    after: "\
        [M1FixedObjects]\n\
        NrOfEntries=1\n\
        1=0x6000",
};
