use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0322",
    severity: Warning,
    title: "sub-index is no VAR",
    why: "The object code of a sub-index is VAR, or DOMAIN. It is taken for a VAR.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "a sub-index is a VAR, not `{given}`",
    help: "write `{ObjectType=0x7}`",
    ..Rule::NEW
};

/// The finding about the ObjectType of a sub-index.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given)
        .key(Key::ObjectType)
        .fix(Fix::unsafe_fix().replace(given.span, "0x7"))
}
