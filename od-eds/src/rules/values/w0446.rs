//! W0446: text is not ASCII.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0446",
    severity: Warning,
    title: "text is not ASCII",
    why: "A VISIBLE_STRING has the characters of ISO 646; on the bus others become whatever the reader takes them for.",
    source: "CiA 301, data types",
    ..Rule::NEW
};
