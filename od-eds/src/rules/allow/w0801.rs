//! W0801: odkit-allow names no rule.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0801",
    severity: Warning,
    title: "odkit-allow names no rule",
    why: "`;odkit-allow=` takes the codes of findings of a file, with commas between them. What it says is not followed.",
    source: "odkit",
    ..Rule::NEW
};
