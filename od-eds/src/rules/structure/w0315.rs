//! W0315: ParameterName is missing.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0315",
    severity: Warning,
    title: "ParameterName is missing",
    why: "Every object and every member has a name.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
