//! I0111: file is not ASCII.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0111",
    severity: Info,
    title: "file is not ASCII",
    why: "CiA 306 asks for ASCII. UTF-8, UTF-16 and Windows-1252 are read, with or without a byte order mark; many readers know only one of them.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
