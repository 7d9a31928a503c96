//! W0323: Count of a module is none.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0323",
    severity: Warning,
    title: "Count of a module is none",
    why: "Count says how many sub-indices a module adds: a number, or `0;` and the bits that share one. One is taken.",
    source: "CiA 306-1, modular devices",
    mending: Mending::None,
    before: "[M1SubExt6000]\nCount=many\n",
    after: "[M1SubExt6000]\nCount=1\n",
};
