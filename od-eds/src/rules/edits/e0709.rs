//! E0709: member with an object code.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0709",
    severity: Error,
    title: "member with an object code",
    why: "The code belongs to the object.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018sub1 { code = var }",
    ..Rule::NEW
};
