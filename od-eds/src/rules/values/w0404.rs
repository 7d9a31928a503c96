//! W0404: AccessType is missing.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0404",
    severity: Warning,
    title: "AccessType is missing",
    why: "Every value says who may write it. `ro` is taken.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
