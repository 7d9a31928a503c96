use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::rules::text::w0106::FIRST;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0107",
    severity: Warning,
    title: "duplicate key",
    why: "Tools differ in which of the two they use. odkit uses the first.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Either,
    says: "duplicate key `{name}`",
    help: "remove `{name}={given}`{fix}",
    ..Rule::NEW
};

/// The finding about a second line of a key; safe to remove if it says the same as the first.
pub(crate) fn finding(first: Span, key: &Text<'_>, value: &Text<'_>, same: bool) -> Finding {
    let fix = match same {
        true => Fix::safe(),
        // A tool that uses the last one reads another value then.
        false => Fix::unsafe_fix(),
    };
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", &*value.value)
        .related(first, FIRST)
        .fix(fix.remove_line(key.span))
}
