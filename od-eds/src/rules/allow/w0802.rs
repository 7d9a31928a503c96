//! W0802: odkit-allow gives no reason.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0802",
    severity: Warning,
    title: "odkit-allow gives no reason",
    why: "Who reads the file next has to know why a finding is no fault. Nothing is allowed without a reason.",
    source: "odkit",
    before: "\
        [2000]\n\
        ParameterName=Gain\n\
        ;odkit-allow=W0420\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    after: "\
        [2000]\n\
        ParameterName=Gain\n\
        ;odkit-allow=W0420 an old tool writes it so\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    ..Rule::NEW
};
