//! W0215: list of a module does not match its sections.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0215",
    severity: Warning,
    title: "list of a module does not match its sections",
    why: "A configuration tool makes the objects that the list names. Every section is read.",
    source: "CiA 306-1, modular devices",
    ..Rule::NEW
};
