use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0802",
    severity: Warning,
    title: "odkit-allow gives no reason",
    why: "The next person who reads the file cannot judge whether the finding is still acceptable. odkit allows nothing without a reason.",
    source: "odkit",
    says: "`odkit-allow={codes}` gives no reason",
    help: "write `;odkit-allow={codes} ` and the reason",
    ..Rule::NEW
};

/// The finding about codes without a reason.
pub(crate) fn finding(codes: &str, span: Span) -> Finding {
    RULE.at(span).fact("codes", codes)
}
