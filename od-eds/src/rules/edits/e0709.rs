//! E0709: member with an object code.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0709",
    severity: Error,
    title: "member with an object code",
    why: "The code belongs to the object.",
    source: "odkit, object_dictionary!",
    mending: Mending::None,
    before: "modify 0x1018sub1 { code = var }",
    after: "modify 0x1018 { code = record }",
};
