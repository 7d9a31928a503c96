//! W0209: compact section without CompactSubObj.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0209",
    severity: Warning,
    title: "compact section without CompactSubObj",
    why: "[xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. The section is kept, and nothing reads it.",
    source: "CiA 306-1, CompactSubObj",
    mending: Mending::None,
    before: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x8\n\
        DataType=0x0005\n\
        PDOMapping=0\n\
        CompactSubObj=3",
};
