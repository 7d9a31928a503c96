//! E0601: object 1000h is missing.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0601",
    severity: Error,
    title: "object 1000h is missing",
    why: "Every CANopen device has it; a master reads it first.",
    source: "CiA 301, object 1000h",
    mending: Mending::None,
    before: "",
    after: "",
};
