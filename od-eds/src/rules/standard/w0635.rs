//! W0635: device has no error control.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0635",
    severity: Warning,
    title: "device has no error control",
    why: "Every device has a heartbeat or node guarding; without one, nobody notices that it is gone.",
    source: "CiA 301, error control",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=0\n\
        \n\
        [1001]\n\
        DataType=0x0005\n\
        AccessType=ro\n\
        DefaultValue=0",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=1\n\
        1=0x1017\n\
        \n\
        [1001]\n\
        DataType=0x0005\n\
        AccessType=ro\n\
        DefaultValue=0\n\
        PDOMapping=0\n\
        \n\
        [1017]\n\
        ParameterName=Producer heartbeat time\n\
        ObjectType=0x7\n\
        DataType=0x0006\n\
        AccessType=rw\n\
        DefaultValue=0",
    ..Rule::NEW
};
