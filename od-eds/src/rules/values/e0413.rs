//! E0413: ParameterValue is no value of its type.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0413",
    severity: Error,
    title: "ParameterValue is no value of its type",
    why: "The value cannot be what the configuration says it is. The dictionary has the default there.",
    source: "CiA 306-1, DCF; CiA 301, data types",
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ParameterValue=fast\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5\n\
        ParameterValue=7\n\
        PDOMapping=0",
    ..Rule::NEW
};
