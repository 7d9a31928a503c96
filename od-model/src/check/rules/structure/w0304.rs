//! W0304: object or sub-index stands twice.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0304",
    severity: Warning,
    title: "object or sub-index stands twice",
    why: "The sections say the same; one is enough.",
    source: "CiA 306-1, object sections",
    mending: Mending::None,
    before: "",
    after: "",
};
