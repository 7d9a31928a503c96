//! E0210: text has no objects.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0210",
    severity: Error,
    title: "text has no objects",
    why: "This is no EDS and no DCF, or an empty one.",
    source: "CiA 306-1",
    mending: Mending::None,
    before: "",
    after: "",
};
