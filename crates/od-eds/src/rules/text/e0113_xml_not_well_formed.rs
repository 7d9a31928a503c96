use crate::finding::{Finding, Rule, Severity::Error};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0113",
    severity: Error,
    title: "XML is not well-formed",
    why: "No tool can read such a file, and odkit reads nothing of it.",
    source: "XML 1.0",
    says: "XML is not well-formed: {error}",
    help: "correct the XML",
    ..Rule::NEW
};

/// The finding about the place where the XML breaks, in the words of its parser.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn finding(at: Span, error: &str) -> Finding {
    RULE.at(at).fact("error", error)
}
