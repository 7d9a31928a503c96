//! E0114: object of an XDD has no index.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0114",
    severity: Error,
    title: "object of an XDD has no index",
    why: "An index is four, a sub-index two hexadecimal digits without `0x`. The element is left out.",
    source: "CiA 311, CANopenObject",
    ..Rule::NEW
};
