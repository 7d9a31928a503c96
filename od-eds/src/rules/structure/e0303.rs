use crate::finding::{Finding, Rule, Severity::Error};
use crate::rules::structure::w0304::twice;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "E0303",
    severity: Error,
    title: "object or sub-index stands twice with different content",
    why: "Two sections for one object contradict each other; readers differ in which one they take. The first counts, with what only the other says.",
    source: "CiA 306-1, object sections",
    says: "[{name}] stands twice, and the two differ",
    help: "remove one of the sections",
    ..Rule::NEW
};

/// The finding about a second section that contradicts the first.
pub(crate) fn finding(first: &Placed<'_>, second: &Placed<'_>) -> Finding {
    twice(&RULE, first, second)
}
