//! I0346: two objects have one name.

use crate::finding::Rule;
use crate::finding::Severity::Info;

pub(crate) static RULE: Rule = Rule {
    code: "I0346",
    severity: Info,
    title: "two objects have one name",
    why: "Masters that find objects by their names find only one of them.",
    source: "odkit; python-canopen and others look up by name",
    ..Rule::NEW
};
