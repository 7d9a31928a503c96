use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0110",
    severity: Warning,
    title: "section header without name",
    why: "No reader can ask for such a section. It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    says: "the section has no name",
    help: "write the name between the brackets",
    ..Rule::NEW
};

/// The finding about empty brackets.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
}
