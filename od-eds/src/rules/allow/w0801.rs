//! W0801: odkit-allow names no rule.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0801",
    severity: Warning,
    title: "odkit-allow names no rule",
    why: "`;odkit-allow=` takes the codes of findings of a file, with commas between them. What it says is not followed.",
    source: "odkit",
    before: "\
        [2000]\n\
        ParameterName=Gain\n\
        ;odkit-allow=W420 an old tool writes it so\n\
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
