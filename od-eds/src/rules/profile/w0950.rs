//! W0950: encoder object has another code or type.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0950",
    severity: Warning,
    title: "encoder object has another code or type",
    why: "A master that knows the object from CiA 406 reads and writes it with another length.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
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
    ..Rule::NEW
};
