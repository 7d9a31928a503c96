use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0318",
    severity: Warning,
    title: "key is probably misspelled",
    why: "A tool ignores the key. odkit keeps the key and ignores it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "`{name}` is not a key of CiA 306 for this section",
    help: "write `{meant}={given}` if this key is meant{fix}",
    ..Rule::NEW
};

/// The finding about a key that is probably misspelled.
pub(crate) fn finding(key: &Text<'_>, value: &str, meant: &str) -> Finding {
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", value)
        .fact("meant", meant)
        .fix(Fix::unsafe_fix().replace(key.span, meant))
}
