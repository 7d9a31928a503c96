use crate::finding::{Finding, Rule, Severity::Error};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0115",
    severity: Error,
    title: "object of an XDD refers to a missing parameter",
    why: "The parameter gives type, access and default value of the object. odkit reads only the attributes of the object itself.",
    source: "CiA 311, CANopenObject",
    says: "no parameter has the uniqueID `{given}`",
    help: "add the parameter, or write its attributes at the object",
    ..Rule::NEW
};

/// The finding about a reference that leads to no parameter.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn finding(at: Span, id: &str) -> Finding {
    RULE.at(at).fact("given", id)
}
