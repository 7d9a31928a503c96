use crate::finding::{Finding, Rule, Severity::Error};
use crate::rules::structure::w0304_duplicate_object::twice;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "E0303",
    severity: Error,
    title: "duplicate object section with different values",
    why: "Tools differ in which of the two sections they use. odkit uses the first, and adds what only the second says.",
    source: "CiA 306-1, object sections",
    says: "duplicate section [{name}] with different values",
    help: "remove one of the sections",
    ..Rule::NEW
};

/// The finding about a second section that contradicts the first.
pub(crate) fn finding(first: &Placed<'_>, second: &Placed<'_>) -> Finding {
    twice(&RULE, first, second)
}
