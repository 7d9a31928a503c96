//! E0210: text has no objects.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0210",
    severity: Error,
    title: "text has no objects",
    why: "This is no EDS and no DCF, or an empty one.",
    source: "CiA 306-1",
    ..Rule::NEW
};
