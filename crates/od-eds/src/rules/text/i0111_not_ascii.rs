use crate::finding::{Finding, Form, Rule, Severity::Info};
use crate::scan::encoding::Encoding;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0111",
    severity: Info,
    title: "file is not ASCII",
    why: "CiA 306 requires ASCII. odkit also reads UTF-8, UTF-16 and Windows-1252, with or without a byte order mark; many EDS parsers read only one of them.",
    source: "CiA 306-1, file format",
    says: "file is encoded in {encoding}",
    help: "save the file as ASCII if a tool cannot read it",
    also: &[MARKED],
    ..Rule::NEW
};

/// The sentence for a file with a byte order mark.
const MARKED: Form = Form {
    says: "file is encoded in {encoding}, with a byte order mark",
    ..Form::OWN
};

/// The finding about a file that is not ASCII, at its first character that is not.
pub(crate) fn finding(first: Span, encoding: Encoding, marked: bool) -> Finding {
    let finding = RULE.at(first).fact("encoding", encoding.name());
    if marked {
        finding.form(&MARKED)
    } else {
        finding
    }
}
