//! W0452: default is outside its limits.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0452",
    severity: Warning,
    title: "default is outside its limits",
    why: "A device refuses to be set to what its own default is. The default is taken as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    mending: Mending::None,
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
};
