//! W0311: sub-index 0 is lower than the highest member.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0311",
    severity: Warning,
    title: "sub-index 0 is lower than the highest member",
    why: "A master that reads up to sub-index 0 never sees the members above it.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    before: "\
        [2000sub0]\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=1\n\
        PDOMapping=0",
    after: "\
        [2000sub0]\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=2\n\
        PDOMapping=0",
    ..Rule::NEW
};
