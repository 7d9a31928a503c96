//! W0902: drive lacks a mandatory object.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0902",
    severity: Warning,
    title: "drive lacks a mandatory object",
    why: "A master controls every CiA 402 drive by these objects.",
    source: "CiA 402, object overview",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=3\n\
        1=0x1017\n\
        2=0x6040\n\
        3=0x6502\n\
        \n\
        [6040]\n\
        DataType=0x0006",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=4\n\
        1=0x1017\n\
        2=0x6040\n\
        3=0x6041\n\
        4=0x6502\n\
        \n\
        [6041]\n\
        ParameterName=Statusword\n\
        ObjectType=0x7\n\
        DataType=0x0006\n\
        AccessType=ro\n\
        DefaultValue=0\n\
        PDOMapping=0",
    ..Rule::NEW
};
