//! E0601: object 1000h is missing.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0601",
    severity: Error,
    title: "object 1000h is missing",
    why: "Every CANopen device has it; a master reads it first.",
    source: "CiA 301, object 1000h",
    before: "\
        [MandatoryObjects]\n\
        SupportedObjects=2\n\
        1=0x1001\n\
        2=0x1018\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=0",
    after: "\
        [MandatoryObjects]\n\
        SupportedObjects=3\n\
        1=0x1000\n\
        2=0x1001\n\
        3=0x1018\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=0\n\
        \n\
        [1000]\n\
        ParameterName=Device type\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=ro\n\
        DefaultValue=0x00000000\n\
        PDOMapping=0",
    ..Rule::NEW
};
