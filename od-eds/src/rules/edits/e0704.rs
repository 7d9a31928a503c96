//! E0704: object has no members.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0704",
    severity: Error,
    title: "object has no members",
    why: "Only a RECORD or an ARRAY has sub-indices.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017sub1 { name = \"Second\"; type = u16 }   // 1017h is a VAR",
    ..Rule::NEW
};
