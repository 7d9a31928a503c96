use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::encoding::Encoding;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0112",
    severity: Warning,
    title: "byte is no character of the file's encoding",
    why: "Two encodings in one file, or a file that was cut. In UTF-8 the byte is read as Windows-1252, in UTF-16 as U+FFFD; a file that is written back keeps it.",
    source: "CiA 306-1, file format",
    says: "here is a byte that is no character of {encoding}",
    help: "write the character anew, or save the file in one encoding",
    ..Rule::NEW
};

/// The finding about the first byte that is none of the encoding's characters.
pub(crate) fn finding(at: Span, encoding: Encoding) -> Finding {
    RULE.at(at).fact("encoding", encoding.name())
}
