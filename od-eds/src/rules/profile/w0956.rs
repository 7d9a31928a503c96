//! W0956: more units a revolution than there are.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0956",
    severity: Warning,
    title: "more units a revolution than there are",
    why: "6001h cannot be finer than the resolution that 6501h says.",
    source: "CiA 406, objects 6001h and 6501h",
    ..Rule::NEW
};
