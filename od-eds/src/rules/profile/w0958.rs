//! W0958: cyclic timer differs from the event timer.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0958",
    severity: Warning,
    title: "cyclic timer differs from the event timer",
    why: "6200h and 1800h:05 are one timer.",
    source: "CiA 406, object 6200h",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
