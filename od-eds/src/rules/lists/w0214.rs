use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::rules::lists::w0242::renumbered;
use crate::scan::placed::{Placed, Text};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0214",
    severity: Warning,
    title: "number of a list stands twice",
    why: "Readers that ask for each number miss one of the two. Both entries are read.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "the number {number} stands twice",
    help: "number the entries from 1 without gaps",
    ..Rule::NEW
};

/// The finding about a number that another entry of the list has.
pub(crate) fn finding(list: &Placed<'_>, key: &Text<'_>, first: Span) -> Finding {
    RULE.at(key.span)
        .fact("number", &*key.value)
        .related(first, "it stands here")
        .fix(renumbered(list))
}
