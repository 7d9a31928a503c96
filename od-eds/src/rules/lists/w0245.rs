//! W0245: segment of [DynamicChannels] is incomplete.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0245",
    severity: Warning,
    title: "segment of [DynamicChannels] is incomplete",
    why: "A programmable device says for every segment the type, the direction and the range of its objects.",
    source: "CiA 306-1, DynamicChannels",
    ..Rule::NEW
};
