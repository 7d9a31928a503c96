//! W0454: mappable, but of no fixed length.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0454",
    severity: Warning,
    title: "mappable, but of no fixed length",
    why: "A string or a DOMAIN has no place in a PDO.",
    source: "CiA 301, data types and PDO mapping parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
