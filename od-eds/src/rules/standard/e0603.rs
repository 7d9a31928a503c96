//! E0603: object 1018h is missing.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0603",
    severity: Error,
    title: "object 1018h is missing",
    why: "Every CANopen device has it; a master identifies the device by it.",
    source: "CiA 301, object 1018h",
    before: "\
        [MandatoryObjects]\n\
        SupportedObjects=2\n\
        1=0x1000\n\
        2=0x1001\n\
        \n\
        [1017]\n\
        DataType=0x0006",
    after: "\
        [MandatoryObjects]\n\
        SupportedObjects=3\n\
        1=0x1000\n\
        2=0x1001\n\
        3=0x1018\n\
        \n\
        [1018]\n\
        ParameterName=Identity object\n\
        ObjectType=0x9\n\
        SubNumber=4\n\
        \n\
        [1018sub0]\n\
        ParameterName=Highest sub-index supported\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=const",
    ..Rule::NEW
};
