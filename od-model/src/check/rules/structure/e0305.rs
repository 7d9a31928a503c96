//! E0305: VAR has sub-indices.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0305",
    severity: Error,
    title: "VAR has sub-indices",
    why: "Only an ARRAY or a RECORD has sub-indices. Where the object has no type of its own it is taken for a RECORD, else the sub-indices are left out.",
    source: "CiA 301, object codes",
    mending: Mending::Unsafe,
    before: "",
    after: "",
};
