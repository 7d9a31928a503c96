//! W0407: ObjFlags is no number.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0407",
    severity: Warning,
    title: "ObjFlags is no number",
    why: "0 is taken.",
    source: "CiA 306-1, ObjFlags",
    mending: Mending::Unsafe,
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
};
