//! W0608: number of PDOs differs from [DeviceInfo].

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0608",
    severity: Warning,
    title: "number of PDOs differs from [DeviceInfo]",
    why: "NrOfRxPDO and NrOfTxPDO count the PDOs of the device.",
    source: "CiA 306-1, DeviceInfo",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
