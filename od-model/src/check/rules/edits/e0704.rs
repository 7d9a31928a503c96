//! E0704: object has no members.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0704",
    severity: Error,
    title: "object has no members",
    why: "Only a RECORD or an ARRAY has sub-indices.",
    source: "odkit, object_dictionary!",
    mending: Mending::None,
    before: "",
    after: "",
};
