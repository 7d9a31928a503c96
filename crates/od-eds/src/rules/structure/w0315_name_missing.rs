use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0315",
    severity: Warning,
    title: "ParameterName is missing",
    why: "A tool shows the object without a name. Every object and every sub-object has one.",
    source: "CiA 306-1, object sections",
    says: "{ParameterName} is missing",
    help: "write `{ParameterName=}` and a name",
    ..Rule::NEW
};

/// The finding about a section without ParameterName.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
}
