//! W0452: default is outside its limits.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0452",
    severity: Warning,
    title: "default is outside its limits",
    why: "A device refuses to be set to what its own default is. The default is taken as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    ..Rule::NEW
};
