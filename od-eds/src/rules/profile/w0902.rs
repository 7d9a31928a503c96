//! W0902: drive lacks a mandatory object.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0902",
    severity: Warning,
    title: "drive lacks a mandatory object",
    why: "A master controls every CiA 402 drive by these objects.",
    source: "CiA 402, object overview",
    ..Rule::NEW
};
