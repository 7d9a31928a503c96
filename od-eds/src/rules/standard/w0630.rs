//! W0630: standard object has another object code.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0630",
    severity: Warning,
    title: "standard object has another object code",
    why: "A master that knows the object from the standard reads sub-indices that do not exist, or misses those that do.",
    source: "CiA 301, chapter 7.5; CiA 302",
    before: "\
        [1016]\n\
        ParameterName=Consumer heartbeat time\n\
        ObjectType=0x7\n\
        DataType=0x0007",
    after: "\
        [1016]\n\
        ParameterName=Consumer heartbeat time\n\
        ObjectType=0x8\n\
        SubNumber=2\n\
        \n\
        [1016sub0]\n\
        ParameterName=Highest sub-index supported\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=1\n\
        PDOMapping=0\n\
        \n\
        [1016sub1]\n\
        ParameterName=Consumer 1\n\
        ObjectType=0x7",
    ..Rule::NEW
};
