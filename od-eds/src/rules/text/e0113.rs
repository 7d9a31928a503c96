//! E0113: XML is not well-formed.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0113",
    severity: Error,
    title: "XML is not well-formed",
    why: "Nothing can be read of such a file.",
    source: "XML 1.0",
    ..Rule::NEW
};
