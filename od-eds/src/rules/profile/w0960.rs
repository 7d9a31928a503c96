//! W0960: cams are incomplete.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0960",
    severity: Warning,
    title: "cams are incomplete",
    why: "A cam channel has its state, enable, polarity, two limits and a hysteresis.",
    source: "CiA 406, objects 6300h to 6330h",
    ..Rule::NEW
};
