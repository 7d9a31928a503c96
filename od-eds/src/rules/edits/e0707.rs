//! E0707: value of an edit is none of its type.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0707",
    severity: Error,
    title: "value of an edit is none of its type",
    why: "A default or a limit is a value of the entry's type.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\"; type = u8; default = 300 }",
    ..Rule::NEW
};
