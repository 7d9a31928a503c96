//! W0419: byte string is not hexadecimal.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0419",
    severity: Warning,
    title: "byte string is not hexadecimal",
    why: "An OCTET_STRING or a DOMAIN is written as hexadecimal bytes. The characters are taken for the bytes.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    before: "\
        [2000]\n\
        DataType=0x000A\n\
        AccessType=rw\n\
        DefaultValue=OPEN\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x000A\n\
        AccessType=rw\n\
        DefaultValue=4F 50 45 4E\n\
        PDOMapping=0",
    ..Rule::NEW
};
