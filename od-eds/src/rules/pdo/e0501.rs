//! E0501: PDO maps an object that does not exist.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0501",
    severity: Error,
    title: "PDO maps an object that does not exist",
    why: "The PDO cannot be made.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
