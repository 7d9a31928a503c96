//! W0244: NrOfEntries does not count its list.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0244",
    severity: Warning,
    title: "NrOfEntries does not count its list",
    why: "A configuration tool reads as many entries as it says and no more.",
    source: "CiA 306-1, SupportedModules",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
