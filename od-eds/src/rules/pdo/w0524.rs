//! W0524: mapping counts more than 64 objects.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0524",
    severity: Warning,
    title: "mapping counts more than 64 objects",
    why: "A PDO has 64 bits, so at most 64 objects; 254 and 255 say that it is multiplexed.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
