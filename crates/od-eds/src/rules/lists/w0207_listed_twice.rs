use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0207",
    severity: Warning,
    title: "object is listed twice",
    why: "Some tools create two objects. odkit ignores the second entry.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "duplicate entry for {object}",
    help: "remove one of the entries{fix}",
    ..Rule::NEW
};

/// The finding about a second entry for an object.
pub(crate) fn finding(entry: Span, index: u16, first: Span) -> Finding {
    RULE.at(entry)
        .index(index)
        .related(first, "first listed here")
        .fix(Fix::safe().remove_line(entry))
}
