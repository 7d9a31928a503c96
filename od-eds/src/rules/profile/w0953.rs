//! W0953: position is not mappable.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0953",
    severity: Warning,
    title: "position is not mappable",
    why: "The position is what an encoder sends in its PDOs.",
    source: "CiA 406, object 6004h",
    mending: Mending::Unsafe,
    before: "\
        [6004]\n\
        DataType=0x0007\n\
        DefaultValue=0\n\
        PDOMapping=0",
    after: "\
        [6004]\n\
        DataType=0x0007\n\
        DefaultValue=0\n\
        PDOMapping=1",
};
