//! E0310: sub-index 0 promises members that do not exist.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0310",
    severity: Error,
    title: "sub-index 0 promises members that do not exist",
    why: "A master that reads up to the highest sub-index gets an abort. A value that counts entries in use may be lower than the members, never higher.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
