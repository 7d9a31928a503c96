//! E0403: value has the type of a record.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0403",
    severity: Error,
    title: "value has the type of a record",
    why: "0020h–0023h describe whole objects; a value has one of the basic types. It is left out of the dictionary.",
    source: "CiA 301, data types",
    ..Rule::NEW
};
