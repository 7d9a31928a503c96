//! W0903: measuring device lacks what it says it has.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0903",
    severity: Warning,
    title: "measuring device lacks what it says it has",
    why: "1000h of a CiA 404 device says which function blocks it has; each has its process values.",
    source: "CiA 404, object 1000h",
    ..Rule::NEW
};
