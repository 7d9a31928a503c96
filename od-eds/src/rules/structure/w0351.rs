//! W0351: ARRAY has a gap.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0351",
    severity: Warning,
    title: "ARRAY has a gap",
    why: "The members of an ARRAY have the sub-indices 1, 2, 3 and so on; a master that walks through it gets an abort at the gap.",
    source: "CiA 301, object codes",
    before: "\
        [2000sub0]\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=3\n\
        PDOMapping=0\n\
        \n\
        [2000sub3]\n\
        ParameterName=Gain 2\n\
        DataType=0x0005",
    after: "\
        [2000sub0]\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=2\n\
        PDOMapping=0\n\
        \n\
        [2000sub2]\n\
        ParameterName=Gain 2\n\
        DataType=0x0005",
    ..Rule::NEW
};
