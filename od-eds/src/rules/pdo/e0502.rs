//! E0502: PDO maps an object that is not mappable.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0502",
    severity: Error,
    title: "PDO maps an object that is not mappable",
    why: "PDOMapping=0 forbids it.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
