use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0304",
    severity: Warning,
    title: "object or sub-index stands twice",
    why: "The sections do not contradict each other; one is enough. What only one of them says counts.",
    source: "CiA 306-1, object sections",
    says: "[{name}] stands twice",
    help: "remove one of the sections",
    ..Rule::NEW
};

/// The finding about a second section that does not contradict the first.
pub(crate) fn finding(first: &Placed<'_>, second: &Placed<'_>) -> Finding {
    twice(&RULE, first, second)
}

/// A finding about the second of two sections.
pub(super) fn twice(rule: &'static Rule, first: &Placed<'_>, second: &Placed<'_>) -> Finding {
    let finding = rule.at(second.header).fact("name", &*second.name.value);
    finding.related(first.header, "this one counts")
}
