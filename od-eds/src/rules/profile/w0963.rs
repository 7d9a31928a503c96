//! W0963: no PDO carries the position.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0963",
    severity: Warning,
    title: "no PDO carries the position",
    why: "As it is shipped, an encoder sends its position in the first TPDO.",
    source: "CiA 406, PDO mapping",
    before: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x65030010\n\
        PDOMapping=0",
    after: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x60040020\n\
        PDOMapping=0",
    ..Rule::NEW
};
