//! E0301: ObjectType is no object code.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0301",
    severity: Error,
    title: "ObjectType is no object code",
    why: "The object code says what kind of object it is. It is guessed from what the object has.",
    source: "CiA 301, object codes",
    before: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x70\n\
        DataType=0x0005",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    ..Rule::NEW
};
