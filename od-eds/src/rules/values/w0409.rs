//! W0409: number with a leading 0 is not octal.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0409",
    severity: Warning,
    title: "number with a leading 0 is not octal",
    why: "`08` is no octal number. It is read as decimal; many readers refuse it.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
