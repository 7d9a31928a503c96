//! W0203: file has no object lists.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0203",
    severity: Warning,
    title: "file has no object lists",
    why: "A reader that follows the lists sees no objects. Every section is taken for an object.",
    source: "CiA 306-1, object lists",
    mending: Mending::None,
    before: "",
    after: "",
};
