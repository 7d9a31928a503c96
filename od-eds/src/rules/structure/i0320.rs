//! I0320: field is empty.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0320",
    severity: Info,
    title: "field is empty",
    why: "A number, a type or an access says nothing when it is empty. It is read as if the line were not there; many readers stop at it.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
