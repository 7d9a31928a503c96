//! E0603: object 1018h is missing.

use crate::finding::Rule;
use crate::finding::Severity::Error;

pub(crate) static RULE: Rule = Rule {
    code: "E0603",
    severity: Error,
    title: "object 1018h is missing",
    why: "Every CANopen device has it; a master identifies the device by it.",
    source: "CiA 301, object 1018h",
    ..Rule::NEW
};
