//! W0316: SubNumber is no number.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0316",
    severity: Warning,
    title: "SubNumber is no number",
    why: "SubNumber is the number of sub-index sections. They are counted instead.",
    source: "CiA 306-1, object sections",
    ..Rule::NEW
};
