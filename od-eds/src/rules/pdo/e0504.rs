//! E0504: PDO maps an object with a wrong length.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0504",
    severity: Error,
    title: "PDO maps an object with a wrong length",
    why: "The last byte of a mapping entry is the object's length in bits.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
