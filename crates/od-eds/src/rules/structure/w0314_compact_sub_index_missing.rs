use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0314",
    severity: Warning,
    title: "compact section names a missing sub-index",
    why: "A tool cannot apply the entry. odkit ignores it.",
    source: "CiA 306-1, CompactSubObj",
    says: "sub-index `{given}` does not exist",
    help: "write a sub-index from 1 to {count}",
    ..Rule::NEW
};

/// The finding about an entry of a compact section for a sub-index that does not exist.
pub(crate) fn finding(given: &Text<'_>, count: &Spanned<u8>) -> Finding {
    RULE.given(given)
        .fact("count", count.value)
        .related(count.span, "sub-objects counted here")
}
