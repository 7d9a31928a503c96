//! I0803: odkit-allow allows nothing.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0803",
    severity: Info,
    title: "odkit-allow allows nothing",
    why: "The finding that was allowed here is not found any more.",
    source: "odkit",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
