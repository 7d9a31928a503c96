//! I0515: CompactPDO stands for PDO objects.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0515",
    severity: Info,
    title: "CompactPDO stands for PDO objects",
    why: "They have no sections. They are made with the sub-indices that its bits name; a reader that does not know CompactPDO lacks them.",
    source: "CiA 306-1, DeviceInfo",
    ..Rule::NEW
};
