use crate::finding::{Finding, Rule};
use crate::span::Span;

pub(crate) static I0515: Rule = Rule {
    title: "CompactPDO replaces sections of PDO objects",
    why: "odkit makes these objects with the sub-indices that the bits name. A tool that does not support CompactPDO lacks them.",
    source: "CiA 306-1, DeviceInfo",
    says: "CompactPDO replaces {count:object|objects} of {word}s",
    help: "add the sections if a tool does not support CompactPDO",
    ..Rule::of("I0515")
};

/// The finding about objects that have no section.
pub(crate) fn finding(span: Span, count: usize, word: &str) -> Finding {
    I0515.at(span).fact("count", count).fact("word", word)
}
