use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0101",
    severity: Warning,
    title: "line is not a section, a key or a comment",
    why: "Most EDS parsers stop at such a line. odkit ignores it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` is not a section, a `key=value` line or a comment",
    help: "start the line with `;`{fix}, or remove it",
    ..Rule::NEW
};

/// The finding about a line that is nothing known.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    let finding = RULE.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}
