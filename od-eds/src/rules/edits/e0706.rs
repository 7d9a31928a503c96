//! E0706: added value has no type.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0706",
    severity: Error,
    title: "added value has no type",
    why: "A handle has a Rust type.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\" }",
    ..Rule::NEW
};
