//! W0307: ARRAY or RECORD has no sub-index 0.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0307",
    severity: Warning,
    title: "ARRAY or RECORD has no sub-index 0",
    why: "A master reads sub-index 0 to learn how many members there are.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    before: "\
        [2000]\n\
        ObjectType=0x9\n\
        SubNumber=2",
    after: "\
        [2000]\n\
        ObjectType=0x9\n\
        SubNumber=3\n\
        \n\
        [2000sub0]\n\
        ParameterName=Highest sub-index supported\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=2\n\
        PDOMapping=0",
    ..Rule::NEW
};
