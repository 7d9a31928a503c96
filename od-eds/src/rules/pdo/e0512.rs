//! E0512: PDO maps a sub-index that does not exist.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0512",
    severity: Error,
    title: "PDO maps a sub-index that does not exist",
    why: "The PDO cannot be made.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
