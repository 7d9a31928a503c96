//! I0212: section name is not written as `1018` or `1018sub2`.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0212",
    severity: Info,
    title: "section name is not written as `1018` or `1018sub2`",
    why: "Four hexadecimal digits, and behind `sub` as many as it takes. Other ways are read the same; many readers do not see the object.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
