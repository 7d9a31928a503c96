//! E0512: PDO maps a sub-index that does not exist.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0512",
    severity: Error,
    title: "PDO maps a sub-index that does not exist",
    why: "The PDO cannot be made.",
    source: "CiA 301, PDO mapping parameter",
    before: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000120\n\
        PDOMapping=0",
    after: "\
        [1A00sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000020\n\
        PDOMapping=0",
    ..Rule::NEW
};
