//! I0803: odkit-allow allows nothing.

use crate::Severity::Info;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "I0803",
    severity: Info,
    title: "odkit-allow allows nothing",
    why: "The finding that was allowed here is not found any more.",
    source: "odkit",
    mending: Mending::Unsafe,
    before: "",
    after: "",
};
