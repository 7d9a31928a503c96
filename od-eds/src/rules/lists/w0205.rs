//! W0205: list entry is no index.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0205",
    severity: Warning,
    title: "list entry is no index",
    why: "An entry is a number and an index, as in `1=0x1000`. It is ignored.",
    source: "CiA 306-1, object lists",
    ..Rule::NEW
};
