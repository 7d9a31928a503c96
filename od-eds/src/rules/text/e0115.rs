use crate::finding::{Finding, Rule, Severity::Error};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0115",
    severity: Error,
    title: "object of an XDD refers to no parameter",
    why: "Type, access and default of the object are said of the parameter. What the object says itself is read.",
    source: "CiA 311, CANopenObject",
    says: "there is no parameter with the uniqueID `{given}`",
    help: "write the parameter, or the attributes of the object itself",
    ..Rule::NEW
};

/// The finding about a reference that leads to no parameter.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn finding(at: Span, id: &str) -> Finding {
    RULE.at(at).fact("given", id)
}
