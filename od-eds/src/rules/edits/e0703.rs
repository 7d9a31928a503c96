//! E0703: added member has no object.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0703",
    severity: Error,
    title: "added member has no object",
    why: "A member stands in an object; add the object first.",
    source: "odkit, object_dictionary!",
    mending: Mending::None,
    before: "add 0x2000sub1 { name = \"Order\"; type = u8 }",
    after: "\
        add 0x2000 { name = \"Filter\"; code = record }\n\
        add 0x2000sub1 { name = \"Order\"; type = u8 }",
};
