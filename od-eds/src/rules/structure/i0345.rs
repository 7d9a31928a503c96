//! I0345: two members have one name.

use crate::finding::Rule;
use crate::finding::Severity::Info;

pub(crate) static RULE: Rule = Rule {
    code: "I0345",
    severity: Info,
    title: "two members have one name",
    why: "Masters that find values by their names find only one of them.",
    source: "odkit; python-canopen and others look up by name",
    ..Rule::NEW
};
