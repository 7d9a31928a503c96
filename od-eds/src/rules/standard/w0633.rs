//! W0633: standard object lacks a member.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0633",
    severity: Warning,
    title: "standard object lacks a member",
    why: "A master that knows the object from the standard reads the member and gets an abort.",
    source: "CiA 301, chapter 7.5; CiA 302",
    before: "\
        [1200]\n\
        ObjectType=0x9\n\
        SubNumber=2\n\
        \n\
        [1200sub0]\n\
        DataType=0x0005\n\
        DefaultValue=2\n\
        PDOMapping=0",
    after: "\
        [1200]\n\
        ObjectType=0x9\n\
        SubNumber=3\n\
        \n\
        [1200sub0]\n\
        DataType=0x0005\n\
        DefaultValue=2\n\
        PDOMapping=0\n\
        \n\
        [1200sub1]\n\
        ParameterName=COB-ID to server\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=ro\n\
        DefaultValue=$NODEID+0x600\n\
        PDOMapping=0",
    ..Rule::NEW
};
