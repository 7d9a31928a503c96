//! W0308: SubNumber does not count the sub-indices.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0308",
    severity: Warning,
    title: "SubNumber does not count the sub-indices",
    why: "SubNumber is the number of sub-index sections, sub-index 0 included. Readers that trust it miss members.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
