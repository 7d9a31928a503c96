//! W0904: encoder lacks a mandatory object.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0904",
    severity: Warning,
    title: "encoder lacks a mandatory object",
    why: "A master reads position, resolution and status of every CiA 406 encoder in the same objects.",
    source: "CiA 406, object overview",
    ..Rule::NEW
};
