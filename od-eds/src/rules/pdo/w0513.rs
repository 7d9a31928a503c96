//! W0513: PDO maps a BOOLEAN with 8 bits.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0513",
    severity: Warning,
    title: "PDO maps a BOOLEAN with 8 bits",
    why: "A BOOLEAN has one bit in a PDO. Some stacks send a byte, and a master that goes by the type reads the rest of the PDO wrong.",
    source: "CiA 301, data types and PDO mapping parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
