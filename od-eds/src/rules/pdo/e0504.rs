//! E0504: PDO maps an object with a wrong length.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0504",
    severity: Error,
    title: "PDO maps an object with a wrong length",
    why: "The last byte of a mapping entry is the object's length in bits.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    before: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000010\n\
        PDOMapping=0",
    after: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000020\n\
        PDOMapping=0",
    ..Rule::NEW
};
