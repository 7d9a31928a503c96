//! W0906: profile object has another access.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0906",
    severity: Warning,
    title: "profile object has another access",
    why: "What a profile has as read only is not to be written; what is written by masters must be writable.",
    source: "CiA 401 and CiA 402, object overview",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
