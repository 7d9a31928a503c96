//! I0240: [FileInfo] or [DeviceInfo] is missing.

use crate::finding::Rule;
use crate::finding::Severity::Info;

pub(crate) static RULE: Rule = Rule {
    code: "I0240",
    severity: Info,
    title: "[FileInfo] or [DeviceInfo] is missing",
    why: "Tools read there what the file is, and which device it is for.",
    source: "CiA 306-1, FileInfo and DeviceInfo",
    ..Rule::NEW
};
