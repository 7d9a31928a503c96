//! W0245: segment of [DynamicChannels] is incomplete.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0245",
    severity: Warning,
    title: "segment of [DynamicChannels] is incomplete",
    why: "A programmable device says for every segment the type, the direction and the range of its objects.",
    source: "CiA 306-1, DynamicChannels",
    mending: Mending::None,
    before: "\
        [DynamicChannels]\n\
        Type1=0x0005\n\
        Range1=0xA000-0xA03F",
    after: "\
        [DynamicChannels]\n\
        Type1=0x0005\n\
        Dir1=ro\n\
        Range1=0xA000-0xA03F",
};
