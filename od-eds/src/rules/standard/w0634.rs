//! W0634: LSS without an LSS address.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0634",
    severity: Warning,
    title: "LSS without an LSS address",
    why: "A device is selected by vendor, product, revision and serial number: 1018h needs all four.",
    source: "CiA 305, LSS address",
    ..Rule::NEW
};
