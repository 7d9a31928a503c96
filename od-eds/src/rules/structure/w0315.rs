//! W0315: ParameterName is missing.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0315",
    severity: Warning,
    title: "ParameterName is missing",
    why: "Every object and every member has a name.",
    source: "CiA 306-1, object sections",
    mending: Mending::None,
    before: "\
        [2000]\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x7\n\
        DataType=0x0005",
};
