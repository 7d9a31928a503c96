//! I0528: PDO carries an object twice.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0528",
    severity: Info,
    title: "PDO carries an object twice",
    why: "That is allowed, and hardly ever meant.",
    source: "CiA 301, PDO mapping parameter",
    before: "\
        [1A00sub2]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20000020\n\
        PDOMapping=0",
    after: "\
        [1A00sub2]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x20020020\n\
        PDOMapping=0",
    ..Rule::NEW
};
