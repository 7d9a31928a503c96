//! W0306: ARRAY or RECORD has no members.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0306",
    severity: Warning,
    title: "ARRAY or RECORD has no members",
    why: "There is nothing to read or write. The object is taken not to exist.",
    source: "CiA 306-1, object sections",
    mending: Mending::None,
    before: "",
    after: "",
};
