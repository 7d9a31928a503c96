//! W0638: node ID or bit rate of a DCF is none.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0638",
    severity: Warning,
    title: "node ID or bit rate of a DCF is none",
    why: "A node ID is 1 to 127, a bit rate one of CiA 301. A tool that loads the DCF cannot set it.",
    source: "CiA 306-1, DeviceComissioning",
    ..Rule::NEW
};
