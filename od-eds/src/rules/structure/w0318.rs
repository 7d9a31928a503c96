use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0318",
    severity: Warning,
    title: "key is nearly one of CiA 306",
    why: "It looks like a slip. The key is kept, and nothing reads it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "there is no key `{name}` here",
    help: "write `{meant}={given}`, if that is meant",
    ..Rule::NEW
};

/// The finding about a key that is likely a slip for another.
pub(crate) fn finding(key: &Text<'_>, value: &str, meant: &str) -> Finding {
    RULE.at(key.span)
        .fact("name", &*key.value)
        .fact("given", value)
        .fact("meant", meant)
        .fix(Fix::unsafe_fix().replace(key.span, meant))
}
