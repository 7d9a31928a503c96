//! W0110: section header without name.

use crate::diagnostic::Severity::Warning;
use crate::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0110",
    severity: Warning,
    title: "section header without name",
    why: "No reader can ask for such a section. It is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    mending: Mending::None,
    before: "\
        []\n\
        Lines=1",
    after: "\
        [Comments]\n\
        Lines=1",
};
