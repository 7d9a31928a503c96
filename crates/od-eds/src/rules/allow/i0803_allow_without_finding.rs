use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0803",
    severity: Info,
    title: "odkit-allow matches no finding",
    why: "The finding was corrected, and the comment would hide it if it came back.",
    source: "odkit",
    fixability: Fixability::Unsafe,
    says: "`odkit-allow={code}` matches no finding",
    help: "remove the line{fix}",
    ..Rule::NEW
};

/// The finding about a code that allows nothing.
pub(crate) fn finding(code: &'static str, span: Span) -> Finding {
    let fix = Fix::unsafe_fix().remove_line(span);
    RULE.at(span).fact("code", code).fix(fix)
}
