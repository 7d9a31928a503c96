//! W0103: section header has no closing bracket.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0103",
    severity: Warning,
    title: "section header has no closing bracket",
    why: "Most readers stop at such a line. The header is taken to end with its line.",
    source: "CiA 306-1, file format",
    mending: Mending::Safe,
    before: "\
        [2000\n\
        ParameterName=Gain\n\
        DataType=0x0005",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        DataType=0x0005",
};
