//! E0710: value field of an object with members.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0710",
    severity: Error,
    title: "value field of an object with members",
    why: "Type, access, default and limits belong to the members.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018 { default = 5 }        // a RECORD has no value",
    ..Rule::NEW
};
