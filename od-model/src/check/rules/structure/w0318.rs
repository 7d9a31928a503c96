//! W0318: key is nearly one of CiA 306.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0318",
    severity: Warning,
    title: "key is nearly one of CiA 306",
    why: "It looks like a slip. The key is kept, and nothing reads it.",
    source: "CiA 306-1, object sections",
    mending: Mending::Unsafe,
    before: "DefualtValue=5\n",
    after: "DefaultValue=5\n",
};
