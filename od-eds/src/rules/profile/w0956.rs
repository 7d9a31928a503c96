//! W0956: more units a revolution than there are.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0956",
    severity: Warning,
    title: "more units a revolution than there are",
    why: "6001h cannot be finer than the resolution that 6501h says.",
    source: "CiA 406, objects 6001h and 6501h",
    before: "\
        [6001]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=16384\n\
        PDOMapping=0\n\
        \n\
        [6002]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=67108864\n\
        PDOMapping=0",
    after: "\
        [6001]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=8192\n\
        PDOMapping=0\n\
        \n\
        [6002]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=33554432\n\
        PDOMapping=0",
    ..Rule::NEW
};
