use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0313",
    severity: Warning,
    title: "CompactSubObj is no number from 1 to 254",
    why: "CompactSubObj is the number of members besides sub-index 0. What cannot be a sub-index is left out.",
    source: "CiA 306-1, CompactSubObj",
    says: "{CompactSubObj} is a number from 1 to 254, not `{given}`",
    help: "write the number of members besides sub-index 0",
    ..Rule::NEW
};

/// The finding about a CompactSubObj that does not count members.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::CompactSubObj)
}
