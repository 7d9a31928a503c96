//! E0601: object 1000h is missing.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0601",
    severity: Error,
    title: "object 1000h is missing",
    why: "Every CANopen device has it; a master reads it first.",
    source: "CiA 301, object 1000h",
    ..Rule::NEW
};
