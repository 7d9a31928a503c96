use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0801",
    severity: Warning,
    title: "odkit-allow names no rule",
    why: "The finding that the author has judged is still reported. `;odkit-allow=` accepts codes of findings in a file, separated by commas; odkit ignores any other code.",
    source: "odkit",
    says: "`{given}` is not the code of a finding",
    help: "write a code such as `W0311`; `odkit explain --list` lists them all",
    ..Rule::NEW
};

/// The finding about a code that does not exist, or that no file can allow.
pub(crate) fn finding(given: &str, span: Span) -> Finding {
    RULE.at(span).fact("given", given)
}
