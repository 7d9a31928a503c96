use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0105",
    severity: Warning,
    title: "key before the first section",
    why: "A key belongs to a section. It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    says: "`{name}` stands before the first section",
    help: "write the section's name above it, for example `[FileInfo]`",
    ..Rule::NEW
};

/// The finding about a key without a section.
pub(crate) fn finding(line: Span, key: &str) -> Finding {
    RULE.at(line).fact("name", key)
}
