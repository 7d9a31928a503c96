//! E0510: mapping entry is no UNSIGNED32.

use crate::finding::Severity::Error;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "E0510",
    severity: Error,
    title: "mapping entry is no UNSIGNED32",
    why: "A mapping entry is index, sub-index and length in one UNSIGNED32.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    before: "\
        [1A00sub1]\n\
        ObjectType=0x7\n\
        DataType=0x0006\n\
        AccessType=rw\n\
        DefaultValue=0x2000\n\
        PDOMapping=0",
    after: "\
        [1A00sub1]\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000020\n\
        PDOMapping=0",
    ..Rule::NEW
};
