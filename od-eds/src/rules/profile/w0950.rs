//! W0950: encoder object has another code or type.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0950",
    severity: Warning,
    title: "encoder object has another code or type",
    why: "A master that knows the object from CiA 406 reads and writes it with another length.",
    source: "CiA 406, object overview",
    mending: Mending::Unsafe,
    before: "\
        [6004]\n\
        ObjectType=0x7\n\
        DataType=0x0006\n\
        AccessType=ro",
    after: "\
        [6004]\n\
        ObjectType=0x7\n\
        DataType=0x0007\n\
        AccessType=ro",
};
