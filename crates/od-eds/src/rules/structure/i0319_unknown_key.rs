use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0319",
    severity: Info,
    title: "key is not defined in CiA 306",
    why: "A tool ignores the key. odkit keeps the key and ignores it.",
    source: "CiA 306-1, file format",
    says: "`{name}` is not a key of CiA 306 for this section",
    help: "correct the key, or remove the line if no tool needs it",
    ..Rule::NEW
};

/// The finding about a key that CiA 306 does not define.
pub(crate) fn finding(key: &Text<'_>) -> Finding {
    RULE.at(key.span).fact("name", &*key.value)
}
