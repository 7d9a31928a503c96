//! E0504: PDO maps an object with a wrong length.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0504",
    severity: Error,
    title: "PDO maps an object with a wrong length",
    why: "The last byte of a mapping entry is the object's length in bits.",
    source: "CiA 301, PDO mapping parameter",
    mending: Mending::Unsafe,
    before: "",
    after: "",
};
