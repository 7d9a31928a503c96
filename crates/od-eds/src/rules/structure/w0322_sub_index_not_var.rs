use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0322",
    severity: Error,
    buildable: true,
    title: "sub-index is not a VAR",
    why: "A tool may look for sub-objects of a sub-object. odkit assumes a VAR.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} `{given}` is not valid for a sub-index",
    help: "write `{ObjectType=0x7}`{fix}",
    ..Rule::NEW
};

/// The finding about the ObjectType of a sub-index.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given)
        .key(Key::ObjectType)
        .fix(Fix::unsafe_fix().replace(given.span, "0x7"))
}
