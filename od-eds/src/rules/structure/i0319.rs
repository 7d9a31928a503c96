use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0319",
    severity: Info,
    title: "key is none of CiA 306",
    why: "It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    says: "`{name}` is no key of CiA 306 here",
    help: "it is kept, and nothing reads it",
    ..Rule::NEW
};

/// The finding about a key that CiA 306 does not define.
pub(crate) fn finding(key: &Text<'_>) -> Finding {
    RULE.at(key.span).fact("name", &*key.value)
}
