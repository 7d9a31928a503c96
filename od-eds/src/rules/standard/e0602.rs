//! E0602: object 1001h is missing.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0602",
    severity: Error,
    title: "object 1001h is missing",
    why: "Every CANopen device has it; emergency messages carry it.",
    source: "CiA 301, object 1001h",
    before: "\
        [MandatoryObjects]\n\
        SupportedObjects=2\n\
        1=0x1000\n\
        2=0x1018\n\
        \n\
        [1000]\n\
        DataType=0x0007\n\
        DefaultValue=0x00000000\n\
        PDOMapping=0",
    after: "\
        [MandatoryObjects]\n\
        SupportedObjects=3\n\
        1=0x1000\n\
        2=0x1001\n\
        3=0x1018\n\
        \n\
        [1000]\n\
        DataType=0x0007\n\
        DefaultValue=0x00000000\n\
        PDOMapping=0\n\
        \n\
        [1001]\n\
        ParameterName=Error register\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=ro",
    ..Rule::NEW
};
