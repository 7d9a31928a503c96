use alloc::format;

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::lines;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0109",
    severity: Warning,
    title: "comment after a value",
    why: "A comment needs a line of its own; after a value it is part of the value. odkit ignores it if the value is a number.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` has a comment after the value",
    help: "write `{key={right}}`, and the comment on the next line{fix}",
    ..Rule::NEW
};

/// The finding about a value with a comment behind it, which gets a line of its own.
pub(crate) fn finding(key: Key, given: &Text<'_>, value: &str) -> Finding {
    let comment = given.get(value.len()..).unwrap_or_default().trim();
    let comment = format!(
        "{value}\n{}",
        lines::comment(&comment[comment.len().min(1)..])
    );
    let finding = RULE.given(given).key(key);
    finding
        .fact("right", value)
        .fix(Fix::safe().replace(given.span, comment))
}
