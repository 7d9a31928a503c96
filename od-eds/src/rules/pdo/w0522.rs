//! W0522: identifier has more bits than it says.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0522",
    severity: Warning,
    title: "identifier has more bits than it says",
    why: "Bit 29 of a COB-ID says that the identifier has 29 bits; without it bits 11 to 28 are 0.",
    source: "CiA 301, COB-ID",
    ..Rule::NEW
};
