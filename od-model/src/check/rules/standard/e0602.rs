//! E0602: object 1001h is missing.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0602",
    severity: Error,
    title: "object 1001h is missing",
    why: "Every CANopen device has it; emergency messages carry it.",
    source: "CiA 301, object 1001h",
    mending: Mending::None,
    before: "",
    after: "",
};
