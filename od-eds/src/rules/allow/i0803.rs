//! I0803: odkit-allow allows nothing.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0803",
    severity: Info,
    title: "odkit-allow allows nothing",
    why: "The finding that was allowed here is not found any more.",
    source: "odkit",
    fixability: Fixability::Unsafe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=5\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=5.0\n\
        PDOMapping=0",
    ..Rule::NEW
};
