//! W0642: object without the one it belongs to.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0642",
    severity: Warning,
    title: "object without the one it belongs to",
    why: "Half of a service does nothing: each of the two is there for the other.",
    source: "CiA 301, objects 1005h to 1029h",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=2\n\
        1=0x1006\n\
        2=0x1017\n\
        \n\
        [1018sub3]\n\
        DataType=0x0007",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=3\n\
        1=0x1005\n\
        2=0x1006\n\
        3=0x1017\n\
        \n\
        [1005]\n\
        ParameterName=COB-ID SYNC\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x80\n\
        PDOMapping=0",
    ..Rule::NEW
};
