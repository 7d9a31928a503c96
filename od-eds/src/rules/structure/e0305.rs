//! E0305: VAR has sub-indices.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0305",
    severity: Error,
    title: "VAR has sub-indices",
    why: "Only an ARRAY or a RECORD has sub-indices. It is taken for a RECORD; a value of its own becomes sub-index 0 where there is none.",
    source: "CiA 301, object codes",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
