//! W0215: list of a module does not match its sections.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0215",
    severity: Warning,
    title: "list of a module does not match its sections",
    why: "A configuration tool makes the objects that the list names. Every section is read.",
    source: "CiA 306-1, modular devices",
    before: "[M1FixedObjects]\nNrOfEntries=0\n[M1Fixed2000]\n",
    after: "[M1FixedObjects]\nNrOfEntries=1\n1=0x2000\n[M1Fixed2000]\n",
    ..Rule::NEW
};
