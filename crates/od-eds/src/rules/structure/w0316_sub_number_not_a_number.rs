use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0316",
    severity: Error,
    buildable: true,
    title: "SubNumber is not a number",
    why: "A tool cannot tell how many sub-objects to read. odkit counts the sections.",
    source: "CiA 306-1, object sections",
    says: "{SubNumber} `{given}` is not a number",
    help: "write the number of sub-index sections",
    ..Rule::NEW
};

/// The finding about a SubNumber that is not a number.
pub(crate) fn finding(given: &Text<'_>) -> Finding {
    RULE.given(given).key(Key::SubNumber)
}
