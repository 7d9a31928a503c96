use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0214",
    severity: Warning,
    title: "duplicate number in a list",
    why: "A tool that asks for each number misses one of the two entries. odkit reads both.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "duplicate entry number {number}",
    help: "number the entries 1, 2, 3 and so on{fix}",
    ..Rule::NEW
};

/// The finding about a number that another entry of the list has.
pub(crate) fn finding(renumbered: Fix, key: &Text<'_>, first: Span) -> Finding {
    RULE.at(key.span)
        .fact("number", &*key.value)
        .related(first, "first used here")
        .fix(renumbered)
}
