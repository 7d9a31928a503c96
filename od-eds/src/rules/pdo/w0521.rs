//! W0521: two PDOs have one COB-ID.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0521",
    severity: Warning,
    title: "two PDOs have one COB-ID",
    why: "Two PDOs of one device on one identifier cannot be told apart.",
    source: "CiA 301, PDO communication parameter",
    ..Rule::NEW
};
