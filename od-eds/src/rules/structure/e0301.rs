use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "E0301",
    severity: Error,
    title: "ObjectType is no object code",
    why: "The object code says what kind of object it is. It is guessed from what the object has.",
    source: "CiA 301, object codes",
    says: "`{given}` is no object code",
    help: "write `0x7` for a VAR, `0x8` for an ARRAY, `0x9` for a RECORD",
    ..Rule::NEW
};

/// The finding about an ObjectType that no object code has.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::ObjectType)
}
