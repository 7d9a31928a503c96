//! E0602: object 1001h is missing.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0602",
    severity: Error,
    title: "object 1001h is missing",
    why: "Every CANopen device has it; emergency messages carry it.",
    source: "CiA 301, object 1001h",
    ..Rule::NEW
};
