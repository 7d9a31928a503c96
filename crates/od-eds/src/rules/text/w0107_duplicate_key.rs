use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::rules::text::w0106_duplicate_section::FIRST;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0107",
    severity: Warning,
    title: "duplicate key",
    why: "Some tools stop at a second line with the same key. odkit uses the first.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "duplicate key `{name}`",
    help: "remove `{name}={given}`{fix}",
    ..Rule::NEW
};

/// The finding about a second line of a key that says the same as the first.
pub(crate) fn finding(first: Span, key: &Text<'_>, value: &Text<'_>) -> Finding {
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", &*value.value)
        .related(first, FIRST)
        .fix(Fix::safe().remove_line(key.span))
}
