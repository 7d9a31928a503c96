//! E0706: added value has no type.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0706",
    severity: Error,
    title: "added value has no type",
    why: "A handle has a Rust type.",
    source: "odkit, object_dictionary!",
    mending: Mending::None,
    before: "add 0x2000 { name = \"Gain\" }",
    after: "add 0x2000 { name = \"Gain\"; type = u16 }",
};
