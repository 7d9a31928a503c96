//! W0633: standard object lacks a member.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0633",
    severity: Warning,
    title: "standard object lacks a member",
    why: "A master that knows the object from the standard reads the member and gets an abort.",
    source: "CiA 301, chapter 7.5; CiA 302",
    ..Rule::NEW
};
