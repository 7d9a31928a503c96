//! W0529: PDO waits for SYNC, but there is no 1005h.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0529",
    severity: Warning,
    title: "PDO waits for SYNC, but there is no 1005h",
    why: "Transmission types 0 to 240, 252 and 253 follow SYNC, whose identifier stands in 1005h.",
    source: "CiA 301, PDO communication parameter",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=3\n\
        1=0x1017\n\
        2=0x1800\n\
        3=0x1A00\n\
        \n\
        [1A00sub1]\n\
        DataType=0x0007",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=4\n\
        1=0x1005\n\
        2=0x1017\n\
        3=0x1800\n\
        4=0x1A00\n\
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
