//! W0530: first SDO server is not at its place.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0530",
    severity: Warning,
    title: "first SDO server is not at its place",
    why: "Every master asks the first SDO server with 600h plus the node ID, and waits for 580h plus the node ID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
