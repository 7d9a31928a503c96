//! E0702: what is added exists already.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0702",
    severity: Error,
    title: "what is added exists already",
    why: "A variant is strict: it adds what its base lacks.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017 { name = \"Heartbeat\"; type = u16 }   // it is there already",
    ..Rule::NEW
};
