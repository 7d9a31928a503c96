//! W0959: alarm or warning that is not supported.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0959",
    severity: Warning,
    title: "alarm or warning that is not supported",
    why: "6503h and 6505h show only what 6504h and 6506h say that there is.",
    source: "CiA 406, objects 6503h to 6506h",
    ..Rule::NEW
};
