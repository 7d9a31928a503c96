use crate::finding::{Finding, Rule, Severity::Info};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0515",
    severity: Info,
    title: "CompactPDO stands for PDO objects",
    why: "They have no sections. They are made with the sub-indices that its bits name; a reader that does not know CompactPDO lacks them.",
    source: "CiA 306-1, DeviceInfo",
    says: "CompactPDO stands for {count} objects of {word}s",
    help: "they are made; a reader that does not know CompactPDO lacks them",
    ..Rule::NEW
};

/// The finding about objects that have no section.
pub(crate) fn finding(span: Span, count: usize, word: &str) -> Finding {
    RULE.at(span).fact("count", count).fact("word", word)
}
