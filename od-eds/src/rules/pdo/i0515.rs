//! I0515: CompactPDO stands for PDO objects.

use crate::diagnostic::Severity::Info;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "I0515",
    severity: Info,
    title: "CompactPDO stands for PDO objects",
    why: "They have no sections. They are made with the sub-indices that its bits name; a reader that does not know CompactPDO lacks them.",
    source: "CiA 306-1, DeviceInfo",
    mending: Mending::None,
    before: "\
        [DeviceInfo]\n\
        Granularity=8\n\
        CompactPDO=15\n\
        NrOfRxPDO=1\n\
        NrOfTxPDO=1",
    after: "\
        [DeviceInfo]\n\
        Granularity=8\n\
        CompactPDO=0\n\
        NrOfRxPDO=0\n\
        NrOfTxPDO=1",
};
