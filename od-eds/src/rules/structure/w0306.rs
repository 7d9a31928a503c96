//! W0306: ARRAY or RECORD has no members.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0306",
    severity: Warning,
    title: "ARRAY or RECORD has no members",
    why: "There is nothing to read or write. The object is taken not to exist.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
