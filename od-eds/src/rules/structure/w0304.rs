//! W0304: object or sub-index stands twice.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0304",
    severity: Warning,
    title: "object or sub-index stands twice",
    why: "The sections do not contradict each other; one is enough. What only one of them says counts.",
    source: "CiA 306-1, object sections",
    before: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=5\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005",
    ..Rule::NEW
};
