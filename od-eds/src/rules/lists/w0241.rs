//! W0241: Lines does not count [Comments].

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0241",
    severity: Warning,
    title: "Lines does not count [Comments]",
    why: "A tool that trusts Lines shows too few comments, or stops at a missing one.",
    source: "CiA 306-1, Comments",
    mending: Mending::Safe,
    before: "\
        [Comments]\n\
        Lines=5\n\
        Line1=A case",
    after: "\
        [Comments]\n\
        Lines=2\n\
        Line1=A case",
};
