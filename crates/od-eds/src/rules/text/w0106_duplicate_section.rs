use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0106",
    severity: Warning,
    title: "duplicate section",
    why: "Tools differ in which of the two they use. odkit uses the first and keeps both.",
    source: "CiA 306-1, file format",
    says: "duplicate section [{name}]",
    help: "move the keys of both into one section",
    ..Rule::NEW
};

/// The label at the first of two.
pub(crate) const FIRST: &str = "first defined here";

/// The finding about a second section of a name.
pub(crate) fn finding(second: &Placed<'_>, first: Span) -> Finding {
    let finding = RULE.at(second.header).fact("name", &*second.name.value);
    finding.related(first, FIRST)
}
