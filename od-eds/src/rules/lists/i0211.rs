//! I0211: section is none of CiA 306.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0211",
    severity: Info,
    title: "section is none of CiA 306",
    why: "It is kept, and nothing reads it. Tools put their own notes into sections; a slip in the name of an object hides the object.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
