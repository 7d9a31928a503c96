//! W0525: mapping entry in use maps nothing.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0525",
    severity: Warning,
    title: "mapping entry in use maps nothing",
    why: "Sub-index 0 says how many objects are mapped, and each of these entries names one.",
    source: "CiA 301, PDO mapping parameter",
    before: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=2\n\
        PDOMapping=0",
    after: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=1\n\
        PDOMapping=0",
    ..Rule::NEW
};
