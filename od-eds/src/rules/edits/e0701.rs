//! E0701: edit of what does not exist.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0701",
    severity: Error,
    title: "edit of what does not exist",
    why: "A variant is strict: it changes and removes what its base has.",
    source: "odkit, object_dictionary!",
    example: "modify 0x2000 { default = 7 }      // the EDS has no 2000h",
    ..Rule::NEW
};
