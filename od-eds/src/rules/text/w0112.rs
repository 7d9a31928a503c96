//! W0112: byte is no character of the file's encoding.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0112",
    severity: Warning,
    title: "byte is no character of the file's encoding",
    why: "Two encodings in one file, or a file that was cut. In UTF-8 the byte is read as Windows-1252, in UTF-16 as U+FFFD; a file that is written back keeps it.",
    source: "CiA 306-1, file format",
    ..Rule::NEW
};
