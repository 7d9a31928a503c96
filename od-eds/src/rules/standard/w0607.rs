//! W0607: identity differs from [DeviceInfo].

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0607",
    severity: Warning,
    title: "identity differs from [DeviceInfo]",
    why: "VendorNumber, ProductNumber and RevisionNumber are the defaults of 1018h; a master picks the EDS by them.",
    source: "CiA 306-1, DeviceInfo",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
