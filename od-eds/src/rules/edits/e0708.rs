//! E0708: value of the base is none of the new type.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0708",
    severity: Error,
    title: "value of the base is none of the new type",
    why: "An edit that changes the type says the values anew where they do not fit.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1000 { type = u8 }          // its default does not fit",
    ..Rule::NEW
};
