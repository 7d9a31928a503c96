//! E0703: added member has no object.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0703",
    severity: Error,
    title: "added member has no object",
    why: "A member stands in an object; add the object first.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000sub1 { name = \"Order\"; type = u8 }",
    ..Rule::NEW
};
