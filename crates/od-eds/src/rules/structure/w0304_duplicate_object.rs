use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0304",
    severity: Warning,
    title: "duplicate object section",
    why: "Some tools stop at the second section. odkit uses both; they do not contradict each other.",
    source: "CiA 306-1, object sections",
    says: "duplicate section [{name}]",
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
    finding.related(first.header, "first defined here")
}
