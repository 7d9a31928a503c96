//! E0414: value is outside its limits.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0414",
    severity: Error,
    title: "value is outside its limits",
    why: "A device refuses to be set to what its own default is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ParameterValue=11\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ParameterValue=7\n\
        PDOMapping=0",
    ..Rule::NEW
};
