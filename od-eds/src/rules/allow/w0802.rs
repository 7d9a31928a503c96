//! W0802: odkit-allow gives no reason.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0802",
    severity: Warning,
    title: "odkit-allow gives no reason",
    why: "Who reads the file next has to know why a finding is no fault. Nothing is allowed without a reason.",
    source: "odkit",
    ..Rule::NEW
};
