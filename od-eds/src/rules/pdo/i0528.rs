//! I0528: PDO carries an object twice.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0528",
    severity: Info,
    title: "PDO carries an object twice",
    why: "That is allowed, and hardly ever meant.",
    source: "CiA 301, PDO mapping parameter",
    ..Rule::NEW
};
