//! I0410: two's complement for a negative number.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0410",
    severity: Info,
    title: "two's complement for a negative number",
    why: "In a signed type a hexadecimal number may be the bit pattern: FFh is -1 in an INTEGER8. It is read so; not every reader does.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    before: "\
        [2000]\n\
        DataType=0x0002\n\
        AccessType=rw\n\
        DefaultValue=0xFF\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0002\n\
        AccessType=rw\n\
        DefaultValue=-1\n\
        PDOMapping=0",
    ..Rule::NEW
};
