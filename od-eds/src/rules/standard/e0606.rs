//! E0606: object 1018h is not as CiA 301 says.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0606",
    severity: Error,
    title: "object 1018h is not as CiA 301 says",
    why: "A RECORD with UNSIGNED32 members, read only; sub-index 1, the vendor ID, is mandatory.",
    source: "CiA 301, object 1018h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
