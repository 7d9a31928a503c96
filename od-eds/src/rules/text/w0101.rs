//! W0101: line is no section, no key and no comment.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0101",
    severity: Warning,
    title: "line is no section, no key and no comment",
    why: "Most readers stop at such a line. It is ignored here.",
    source: "CiA 306-1, file format",
    mending: Mending::Safe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        see the manual\n\
        DefaultValue=5",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        ; see the manual\n\
        DefaultValue=5",
};
