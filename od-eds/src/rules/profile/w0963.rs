//! W0963: no PDO carries the position.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0963",
    severity: Warning,
    title: "no PDO carries the position",
    why: "As it is shipped, an encoder sends its position in the first TPDO.",
    source: "CiA 406, PDO mapping",
    ..Rule::NEW
};
