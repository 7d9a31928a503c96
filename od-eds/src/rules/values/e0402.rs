//! E0402: DataType is no data type.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0402",
    severity: Error,
    title: "DataType is no data type",
    why: "DataType is the index of one of CiA 301's types. The value is left out of the dictionary.",
    source: "CiA 301, data types",
    ..Rule::NEW
};
