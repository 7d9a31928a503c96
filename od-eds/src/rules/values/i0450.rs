//! I0450: limits leave one value.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0450",
    severity: Info,
    title: "limits leave one value",
    why: "A value that can be written, but only to what it is: such limits are usually left over from an editor.",
    source: "CiA 306-1, LowLimit and HighLimit",
    ..Rule::NEW
};
