//! E0310: sub-index 0 promises members that do not exist.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0310",
    severity: Error,
    title: "sub-index 0 promises members that do not exist",
    why: "A master that reads up to the highest sub-index gets an abort. A value that counts entries in use may be lower than the members, never higher.",
    source: "CiA 301, object structure",
    mending: Mending::Unsafe,
    before: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=2\n\
        PDOMapping=0",
    after: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=1\n\
        PDOMapping=0",
};
