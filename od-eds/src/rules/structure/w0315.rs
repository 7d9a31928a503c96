//! W0315: ParameterName is missing.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0315",
    severity: Warning,
    title: "ParameterName is missing",
    why: "Every object and every member has a name.",
    source: "CiA 306-1, object sections",
    before: "\
        [2000]\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    ..Rule::NEW
};
