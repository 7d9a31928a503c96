//! W0215: list of a module does not match its sections.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0215",
    severity: Warning,
    title: "list of a module does not match its sections",
    why: "A configuration tool makes the objects that the list names. Every section is read.",
    source: "CiA 306-1, modular devices",
    mending: Mending::None,
    before: "[M1FixedObjects]\nNrOfEntries=0\n[M1Fixed2000]\n",
    after: "[M1FixedObjects]\nNrOfEntries=1\n1=0x2000\n[M1Fixed2000]\n",
};
