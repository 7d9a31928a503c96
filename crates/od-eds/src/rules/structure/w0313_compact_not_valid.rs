use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0313",
    severity: Warning,
    title: "CompactSubObj is not valid",
    why: "A tool creates the wrong number of sub-objects. CompactSubObj counts them without sub-index 0; odkit assumes 254 for a larger number.",
    source: "CiA 306-1, CompactSubObj",
    says: "{CompactSubObj} `{given}` is not a number from 1 to 254",
    help: "write the number of sub-objects without sub-index 0",
    ..Rule::NEW
};

/// The finding about a CompactSubObj that is not valid.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::CompactSubObj)
}
