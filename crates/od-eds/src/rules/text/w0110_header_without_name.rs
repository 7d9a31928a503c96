use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0110",
    severity: Warning,
    title: "section header without a name",
    why: "A tool can find a section only by its name. odkit keeps the section and ignores it.",
    source: "CiA 306-1, file format",
    says: "section header has no name",
    help: "write a name between the brackets",
    ..Rule::NEW
};

/// The finding about empty brackets.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
}
