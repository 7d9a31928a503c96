//! E0115: object of an XDD refers to no parameter.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0115",
    severity: Error,
    title: "object of an XDD refers to no parameter",
    why: "Type, access and default of the object are said of the parameter. What the object says itself is read.",
    source: "CiA 311, CANopenObject",
    ..Rule::NEW
};
