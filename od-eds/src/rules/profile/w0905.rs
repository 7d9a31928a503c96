//! W0905: profile object has another code or type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0905",
    severity: Warning,
    title: "profile object has another code or type",
    why: "A master that knows the object from the device profile reads and writes it with another length.",
    source: "CiA 401 and CiA 402, object overview",
    fixability: Fixability::Unsafe,
    before: "\
        [6041]\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=ro",
    after: "\
        [6041]\n\
        ObjectType=0x7\n\
        DataType=0x0006\n\
        AccessType=ro",
    ..Rule::NEW
};
