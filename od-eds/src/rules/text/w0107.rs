//! W0107: key stands twice in its section.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0107",
    severity: Warning,
    title: "key stands twice in its section",
    why: "Readers differ in which one they take. The first counts.",
    source: "CiA 306-1, file format",
    mending: Mending::Either,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        DefaultValue=5\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        PDOMapping=0",
};
