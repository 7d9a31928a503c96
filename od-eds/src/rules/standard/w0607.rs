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
    before: "\
        [DeviceInfo]\n\
        ProductName=Case\n\
        ProductNumber=0x11\n\
        RevisionNumber=0x10001",
    after: "\
        [DeviceInfo]\n\
        ProductName=Case\n\
        ProductNumber=0x10\n\
        RevisionNumber=0x10001",
    ..Rule::NEW
};
