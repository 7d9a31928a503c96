//! W0209: compact section without CompactSubObj.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0209",
    severity: Warning,
    title: "compact section without CompactSubObj",
    why: "[xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. The section is kept, and nothing reads it.",
    source: "CiA 306-1, CompactSubObj",
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
    ..Rule::NEW
};
