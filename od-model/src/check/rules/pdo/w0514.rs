//! W0514: CompactPDO is not written out.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0514",
    severity: Warning,
    title: "CompactPDO is not written out",
    why: "CompactPDO stands for PDO objects that have no sections. odkit makes none: the device lacks them.",
    source: "CiA 306-1, DeviceInfo",
    mending: Mending::None,
    before: "",
    after: "",
};
