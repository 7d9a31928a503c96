//! I0319: key is none of CiA 306.

use crate::Severity::Info;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "I0319",
    severity: Info,
    title: "key is none of CiA 306",
    why: "It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    mending: Mending::None,
    before: "Unit=mm\n",
    after: ";Unit=mm\n",
};
