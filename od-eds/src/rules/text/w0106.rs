use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0106",
    severity: Warning,
    title: "section stands twice",
    why: "Readers differ in which one they take. The first counts; both are kept.",
    source: "CiA 306-1, file format",
    says: "[{name}] stands twice",
    help: "put the keys of both into one section",
    ..Rule::NEW
};

/// The finding about a second section of a name.
pub(crate) fn finding(second: &Placed<'_>, first: Span) -> Finding {
    let finding = RULE.at(second.header).fact("name", &*second.name.value);
    finding.related(first, "this one counts")
}
