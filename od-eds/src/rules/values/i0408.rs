//! I0408: number with a leading 0 is octal.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0408",
    severity: Info,
    title: "number with a leading 0 is octal",
    why: "`010` is 8. It is read so, as C reads it; not every reader does.",
    source: "CiA 306-1, numbers",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
