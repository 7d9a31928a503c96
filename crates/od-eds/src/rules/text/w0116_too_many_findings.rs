use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0116",
    severity: Warning,
    title: "too many findings of one rule",
    why: "A file with this many findings of one rule is likely not a device description. odkit reports the first 10,000 findings of each rule and counts the others.",
    source: "odkit, limits of a report",
    example: "a file with 10,001 lines that are neither a section, a key nor a comment",
    says: "{rule} has {more:more finding|more findings} from here on",
    help: "correct the first {kept:finding|findings}, then check the file again",
    ..Rule::NEW
};

/// The finding about the first finding of a rule that is left out.
pub(crate) fn finding(first: Span, rule: &str, kept: usize, more: usize) -> Finding {
    let finding = RULE.at(first).fact("rule", rule);
    finding.fact("kept", kept).fact("more", more)
}
