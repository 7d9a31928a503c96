//! E0208: sub-index without its object.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0208",
    severity: Error,
    title: "sub-index without its object",
    why: "The section of the object itself says its code and name. The members are kept in an object without a name.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
