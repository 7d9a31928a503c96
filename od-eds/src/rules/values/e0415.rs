//! E0415: LowLimit is greater than HighLimit.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0415",
    severity: Error,
    title: "LowLimit is greater than HighLimit",
    why: "No value lies between them.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        LowLimit=10\n\
        HighLimit=0\n\
        DefaultValue=",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        LowLimit=0\n\
        HighLimit=10\n\
        DefaultValue=",
    ..Rule::NEW
};
