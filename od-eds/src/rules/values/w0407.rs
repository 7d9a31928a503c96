//! W0407: ObjFlags is no number.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0407",
    severity: Warning,
    title: "ObjFlags is no number",
    why: "0 is taken.",
    source: "CiA 306-1, ObjFlags",
    fixability: Fixability::Unsafe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ObjFlags=none\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ObjFlags=0\n\
        PDOMapping=0",
    ..Rule::NEW
};
