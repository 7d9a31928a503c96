//! W0201: listed object has no section.

use crate::finding::Severity::Warning;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "W0201",
    severity: Warning,
    title: "listed object has no section",
    why: "A master that trusts the lists fails where the section is missing. The object is taken not to exist.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Unsafe,
    ..Rule::NEW
};
