//! E0505: PDO is longer than 64 bits.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0505",
    severity: Error,
    title: "PDO is longer than 64 bits",
    why: "A CAN frame carries eight bytes.",
    source: "CiA 301, PDO mapping parameter",
    mending: Mending::None,
    before: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=3\n\
        PDOMapping=0",
    after: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=2\n\
        PDOMapping=0",
};
