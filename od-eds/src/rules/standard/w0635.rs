//! W0635: device has no error control.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0635",
    severity: Warning,
    title: "device has no error control",
    why: "Every device has a heartbeat or node guarding; without one, nobody notices that it is gone.",
    source: "CiA 301, error control",
    ..Rule::NEW
};
