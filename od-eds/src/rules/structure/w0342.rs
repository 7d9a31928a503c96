//! W0342: ObjFlags has reserved bits.

use crate::finding::Rule;
use crate::finding::Severity::Warning;

pub(crate) static RULE: Rule = Rule {
    code: "W0342",
    severity: Warning,
    title: "ObjFlags has reserved bits",
    why: "Bit 0 says that a download tool leaves the object out, bit 1 the same for uploads; the others are reserved.",
    source: "CiA 306-1, ObjFlags",
    ..Rule::NEW
};
