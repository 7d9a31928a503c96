//! E0412: DefaultValue is no value of its type.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0412",
    severity: Error,
    title: "DefaultValue is no value of its type",
    why: "The value cannot be what the description says it is. The dictionary has no default there.",
    source: "CiA 306-1, object sections; CiA 301, data types",
    ..Rule::NEW
};
