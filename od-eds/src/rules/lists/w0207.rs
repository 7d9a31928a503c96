use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0207",
    severity: Warning,
    title: "object is listed twice",
    why: "One entry is enough; some editors make two objects of two.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "{object} is listed twice",
    help: "remove one of the entries",
    ..Rule::NEW
};

/// The finding about a second entry for an object.
pub(crate) fn finding(entry: Span, index: u16, first: Span) -> Finding {
    RULE.at(entry)
        .index(index)
        .related(first, "it is listed here")
        .fix(Fix::safe().remove_line(entry))
}
