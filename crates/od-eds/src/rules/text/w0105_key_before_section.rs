use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0105",
    severity: Warning,
    title: "key before the first section",
    why: "A key belongs to a section. odkit keeps the key and ignores it.",
    source: "CiA 306-1, file format",
    says: "`{name}` is before the first section",
    help: "write a section header such as `[FileInfo]` above it",
    ..Rule::NEW
};

/// The finding about a key without a section.
pub(crate) fn finding(line: Span, key: &str) -> Finding {
    RULE.at(line).fact("name", key)
}
