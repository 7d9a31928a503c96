//! W0529: PDO waits for SYNC, but there is no 1005h.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0529",
    severity: Warning,
    title: "PDO waits for SYNC, but there is no 1005h",
    why: "Transmission types 0 to 240, 252 and 253 follow SYNC, whose identifier stands in 1005h.",
    source: "CiA 301, PDO communication parameter",
    ..Rule::NEW
};
