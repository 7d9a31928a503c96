//! W0526: mapping is finer than the granularity.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0526",
    severity: Warning,
    title: "mapping is finer than the granularity",
    why: "Granularity in [DeviceInfo] is the smallest number of bits that the device can map.",
    source: "CiA 306-1, DeviceInfo",
    ..Rule::NEW
};
