//! E0507: TPDO maps a dummy.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0507",
    severity: Error,
    title: "TPDO maps a dummy",
    why: "Dummies fill gaps in what is received; there is nothing to send.",
    source: "CiA 301, dummy mapping",
    ..Rule::NEW
};
