//! W0108: `:` instead of `=`.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0108",
    severity: Warning,
    title: "`:` instead of `=`",
    why: "Only some readers know it. It is read as `=`.",
    source: "CiA 306-1, file format",
    mending: Mending::Safe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue:5\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=5\n\
        PDOMapping=0",
};
