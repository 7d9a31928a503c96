//! W0452: default is outside its limits.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0452",
    severity: Warning,
    title: "default is outside its limits",
    why: "A device refuses to be set to what its own default is. The default is taken as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        HighLimit=10\n\
        DefaultValue=20\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        HighLimit=10\n\
        DefaultValue=5\n\
        PDOMapping=0",
    ..Rule::NEW
};
