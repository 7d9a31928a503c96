//! W0609: value of a section that describes no object is none of its kind.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0609",
    severity: Warning,
    title: "value of a section that describes no object is none of its kind",
    why: "Flags are 0 or 1, numbers are numbers within their range. It is kept as text, and counts as missing.",
    source: "CiA 306-1, FileInfo, DeviceInfo, DummyUsage, DeviceComissioning",
    ..Rule::NEW
};
