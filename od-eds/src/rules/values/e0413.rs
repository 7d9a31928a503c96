//! E0413: ParameterValue is no value of its type.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0413",
    severity: Error,
    title: "ParameterValue is no value of its type",
    why: "The value cannot be what the configuration says it is. The dictionary has the default there.",
    source: "CiA 306-1, DCF; CiA 301, data types",
    ..Rule::NEW
};
