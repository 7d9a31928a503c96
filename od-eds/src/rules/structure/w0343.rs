//! W0343: index is reserved.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0343",
    severity: Warning,
    title: "index is reserved",
    why: "Objects of the device stand in 1000h to 9FFFh, types below 0260h, network and system variables from A000h to BFFFh.",
    source: "CiA 301, object dictionary structure",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=2\n\
        1=0x0300\n\
        2=0x1017\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=0\n\
        \n\
        [0300]\n\
        ParameterName=Own\n\
        DataType=0x0005",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=1\n\
        1=0x1017\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=1\n\
        1=0x2000\n\
        \n\
        [2000]\n\
        ParameterName=Own\n\
        DataType=0x0005",
    ..Rule::NEW
};
