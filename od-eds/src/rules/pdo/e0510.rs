//! E0510: mapping entry is no UNSIGNED32.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0510",
    severity: Error,
    title: "mapping entry is no UNSIGNED32",
    why: "A mapping entry is index, sub-index and length in one UNSIGNED32.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
