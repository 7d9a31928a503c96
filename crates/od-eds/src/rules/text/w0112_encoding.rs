use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::encoding::Encoding;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0112",
    severity: Warning,
    title: "byte is not valid in the file's encoding",
    why: "The file mixes two encodings, or is incomplete. odkit reads the byte as Windows-1252 in UTF-8 and as U+FFFD in UTF-16; a file that odkit writes keeps it.",
    source: "CiA 306-1, file format",
    says: "invalid {encoding} byte",
    help: "retype the character, or save the file in one encoding",
    ..Rule::NEW
};

/// The finding about the first byte that is not valid in the encoding.
pub(crate) fn finding(at: Span, encoding: Encoding) -> Finding {
    RULE.at(at).fact("encoding", encoding.name())
}
