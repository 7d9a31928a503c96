//! W0524: mapping counts more than 64 objects.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0524",
    severity: Warning,
    title: "mapping counts more than 64 objects",
    why: "A PDO has 64 bits, so at most 64 objects; 254 and 255 say that it is multiplexed.",
    source: "CiA 301, PDO mapping parameter",
    mending: Mending::None,
    before: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=100\n\
        PDOMapping=0",
    after: "\
        [1A00sub0]\n\
        DataType=0x0005\n\
        AccessType=rw\n\
        DefaultValue=1\n\
        PDOMapping=0",
};
