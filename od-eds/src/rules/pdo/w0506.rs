//! W0506: RPDO maps a dummy that [DummyUsage] does not allow.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0506",
    severity: Warning,
    title: "RPDO maps a dummy that [DummyUsage] does not allow",
    why: "A device says in [DummyUsage] which of the types 0001h–0007h fill gaps.",
    source: "CiA 306-1, DummyUsage",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
