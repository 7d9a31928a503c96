//! E0705: added object has no name.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0705",
    severity: Error,
    title: "added object has no name",
    why: "The handle is called after the name.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { type = u16 }",
    ..Rule::NEW
};
