//! W0508: PDO has only one of its two objects.

use crate::Severity::Warning;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "W0508",
    severity: Warning,
    title: "PDO has only one of its two objects",
    why: "A PDO has a communication and a mapping parameter, 200h apart.",
    source: "CiA 301, PDO communication parameter",
    mending: Mending::None,
    before: "",
    after: "",
};
