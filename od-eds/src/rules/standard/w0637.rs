//! W0637: device supports no bit rate.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0637",
    severity: Warning,
    title: "device supports no bit rate",
    why: "[DeviceInfo] says the bit rates of a device; a tool that offers what all devices have offers nothing.",
    source: "CiA 306-1, DeviceInfo",
    ..Rule::NEW
};
