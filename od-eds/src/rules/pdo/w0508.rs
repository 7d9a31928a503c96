//! W0508: PDO has only one of its two objects.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0508",
    severity: Warning,
    title: "PDO has only one of its two objects",
    why: "A PDO has a communication and a mapping parameter, 200h apart.",
    source: "CiA 301, PDO communication parameter",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=2\n\
        1=0x1017\n\
        2=0x1800\n\
        \n\
        [1800sub2]\n\
        DataType=0x0005",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=3\n\
        1=0x1017\n\
        2=0x1800\n\
        3=0x1A00\n\
        \n\
        [1A00]\n\
        ParameterName=TPDO 1 mapping\n\
        ObjectType=0x9\n\
        SubNumber=2\n\
        \n\
        [1A00sub0]\n\
        ParameterName=Highest sub-index supported\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=rw",
    ..Rule::NEW
};
