//! I0611: DeviceCommissioning with two m.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0611",
    severity: Info,
    title: "DeviceCommissioning with two m",
    why: "The standard writes `DeviceComissioning`. Both are read; many readers know only one.",
    source: "CiA 306-1, DCF",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
