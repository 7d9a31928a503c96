use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::text::w0106_duplicate_section::FIRST;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0117",
    severity: Error,
    buildable: true,
    title: "duplicate key with another value",
    why: "Tools differ in which of the two they use, and some stop. odkit uses the first.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "duplicate key `{name}` with another value",
    help: "remove `{name}={given}`{fix}, or the other line",
    ..Rule::NEW
};

/// The finding about a second line of a key; a tool that uses the last one reads another value.
pub(crate) fn finding(first: Span, key: &Text<'_>, value: &Text<'_>) -> Finding {
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", &*value.value)
        .related(first, FIRST)
        .fix(Fix::unsafe_fix().remove_line(key.span))
}
