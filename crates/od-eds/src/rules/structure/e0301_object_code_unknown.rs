use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "E0301",
    severity: Error,
    title: "ObjectType is not an object code",
    why: "A tool cannot tell a VAR from an ARRAY or a RECORD. odkit assumes a RECORD if sub-objects exist, otherwise a VAR.",
    source: "CiA 301, object codes",
    says: "{ObjectType} `{given}` is not an object code",
    help: "write `{ObjectType=0x7}` (VAR), `{ObjectType=0x8}` (ARRAY) or `{ObjectType=0x9}` (RECORD)",
    ..Rule::NEW
};

/// The finding about an ObjectType that no object code has.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::ObjectType)
}
