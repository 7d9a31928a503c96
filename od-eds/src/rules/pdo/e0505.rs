//! E0505: PDO is longer than 64 bits.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0505",
    severity: Error,
    title: "PDO is longer than 64 bits",
    why: "A CAN frame carries eight bytes.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
