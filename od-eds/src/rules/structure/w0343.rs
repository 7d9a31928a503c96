//! W0343: index is reserved.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0343",
    severity: Warning,
    title: "index is reserved",
    why: "Objects of the device stand in 1000h to 9FFFh, types below 0260h, network and system variables from A000h to BFFFh.",
    source: "CiA 301, object dictionary structure",
    ..Rule::NEW
};
