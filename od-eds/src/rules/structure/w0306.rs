//! W0306: ARRAY or RECORD has no members.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0306",
    severity: Warning,
    title: "ARRAY or RECORD has no members",
    why: "There is nothing to read or write. The object is taken not to exist.",
    source: "CiA 306-1, object sections",
    before: "[2000]",
    after: "\
        [2000sub0]\n\
        ParameterName=Highest sub-index supported\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=const\n\
        DefaultValue=2\n\
        PDOMapping=0\n\
        \n\
        [2000sub1]\n\
        ParameterName=Order\n\
        ObjectType=0x7\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=2\n\
        PDOMapping=0",
    ..Rule::NEW
};
