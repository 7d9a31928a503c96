//! W0404: AccessType is missing.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0404",
    severity: Warning,
    title: "AccessType is missing",
    why: "Every value says who may write it. `ro` is taken.",
    source: "CiA 306-1, object sections",
    mending: Mending::Unsafe,
    before: "\
        [2000]\n\
        DataType=0x0005\n\
        DefaultValue=5",
    after: "\
        [2000]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=5",
};
