//! E0710: value field of an object with members.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0710",
    severity: Error,
    title: "value field of an object with members",
    why: "Type, access, default and limits belong to the members.",
    source: "odkit, object_dictionary!",
    mending: Mending::None,
    before: "modify 0x1018 { default = 5 }        // a RECORD has no value",
    after: "modify 0x1018sub1 { default = 5 }",
};
