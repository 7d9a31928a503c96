//! E0401: DataType is missing.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0401",
    severity: Error,
    title: "DataType is missing",
    why: "Nothing is known of a value without a type. It is left out of the dictionary.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
