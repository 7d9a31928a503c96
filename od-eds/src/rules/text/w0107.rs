use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0107",
    severity: Warning,
    title: "key stands twice in its section",
    why: "Readers differ in which one they take. The first counts.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Either,
    says: "`{name}` stands twice",
    help: "remove `{name}={given}`",
    ..Rule::NEW
};

/// The finding about a second line of a key; safe to remove if it says the same as the first.
pub(crate) fn finding(first: Span, key: &Text<'_>, value: &Text<'_>, same: bool) -> Finding {
    let fix = match same {
        true => Fix::safe(),
        // Whoever takes the last one reads something else then.
        false => Fix::unsafe_fix(),
    };
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", &*value.value)
        .related(first, "this one counts")
        .fix(fix.remove_line(key.span))
}
