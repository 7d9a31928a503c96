//! I0319: key is none of CiA 306.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0319",
    severity: Info,
    title: "key is none of CiA 306",
    why: "It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        Unit=mm\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ; Unit=mm\n\
        PDOMapping=0",
    ..Rule::NEW
};
