use alloc::format;

use crate::finding::{Finding, Rule, Severity::Error};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0205",
    severity: Error,
    buildable: true,
    title: "list entry is not valid",
    why: "A tool does not find the object, or stops. odkit ignores the entry. An entry is a number and an index, as in `1=0x1000`.",
    source: "CiA 306-1, object lists",
    says: "`{entry}` is not a valid list entry",
    help: "write a number and an index, such as `1=0x1000`",
    ..Rule::NEW
};

/// The finding about an entry that is not a number and an index.
pub(crate) fn finding(key: &Text<'_>, value: &Text<'_>) -> Finding {
    RULE.at(key.span)
        .fact("entry", format!("{}={}", key.value, value.value))
}
