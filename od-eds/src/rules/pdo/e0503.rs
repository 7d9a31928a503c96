//! E0503: PDO maps an object of the wrong direction.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0503",
    severity: Error,
    title: "PDO maps an object of the wrong direction",
    why: "A TPDO carries what can be read (ro, rw, rwr, const), an RPDO what can be written (wo, rw, rww).",
    source: "CiA 306-1, AccessType",
    mending: Mending::None,
    before: "\
        [2001]\n\
        DataType=0x0007\n\
        AccessType=ro\n\
        DefaultValue=0",
    after: "\
        [2001]\n\
        DataType=0x0007\n\
        AccessType=rww\n\
        DefaultValue=0",
};
