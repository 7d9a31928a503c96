//! E0305: VAR has sub-indices.

use crate::diagnostic::Severity::Error;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0305",
    severity: Error,
    title: "VAR has sub-indices",
    why: "Only an ARRAY or a RECORD has sub-indices. It is taken for a RECORD; a value of its own becomes sub-index 0 where there is none.",
    source: "CiA 301, object codes",
    mending: Mending::Unsafe,
    before: "\
        [2000]\n\
        ParameterName=Filter\n\
        ObjectType=0x7\n\
        SubNumber=3",
    after: "\
        [2000]\n\
        ParameterName=Filter\n\
        ObjectType=0x9\n\
        SubNumber=3",
};
