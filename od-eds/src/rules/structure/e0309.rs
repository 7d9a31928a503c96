//! E0309: sub-index 0 is no UNSIGNED8.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0309",
    severity: Error,
    title: "sub-index 0 is no UNSIGNED8",
    why: "Sub-index 0 is the highest sub-index, an UNSIGNED8, in every ARRAY and RECORD.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
