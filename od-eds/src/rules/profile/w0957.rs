//! W0957: device type and revolutions disagree.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0957",
    severity: Warning,
    title: "device type and revolutions disagree",
    why: "1000h says whether the encoder counts revolutions, 6502h how many.",
    source: "CiA 406, objects 1000h and 6502h",
    ..Rule::NEW
};
