//! W0508: PDO has only one of its two objects.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0508",
    severity: Warning,
    title: "PDO has only one of its two objects",
    why: "A PDO has a communication and a mapping parameter, 200h apart.",
    source: "CiA 301, PDO communication parameter",
    ..Rule::NEW
};
