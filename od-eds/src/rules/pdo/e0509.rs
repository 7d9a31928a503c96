//! E0509: PDO communication parameter lacks COB-ID or transmission type.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0509",
    severity: Error,
    title: "PDO communication parameter lacks COB-ID or transmission type",
    why: "Sub-index 1 is the COB-ID, an UNSIGNED32, sub-index 2 the transmission type, an UNSIGNED8.",
    source: "CiA 301, PDO communication parameter",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
