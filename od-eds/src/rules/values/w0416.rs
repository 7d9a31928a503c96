//! W0416: limit is no value of its type.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0416",
    severity: Warning,
    title: "limit is no value of its type",
    why: "A limit that the type cannot reach limits nothing. It is left out of the dictionary.",
    source: "CiA 306-1, LowLimit and HighLimit",
    mending: Mending::Unsafe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        LowLimit=0\n\
        HighLimit=1000\n\
        DefaultValue=5",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        LowLimit=0\n\
        HighLimit=\n\
        DefaultValue=5",
};
