use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0316",
    severity: Warning,
    title: "SubNumber is no number",
    why: "SubNumber is the number of sub-index sections. They are counted instead.",
    source: "CiA 306-1, object sections",
    says: "`{given}` is no number",
    help: "write how many sub-index sections there are",
    ..Rule::NEW
};

/// The finding about a SubNumber that is not a number.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::SubNumber)
}
