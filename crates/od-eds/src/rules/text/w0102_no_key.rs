use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0102",
    severity: Warning,
    title: "line has no key before the `=`",
    why: "A tool can read a value only by its key. odkit ignores the line.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` has no key before the `=`",
    help: "start the line with `;`{fix}, or write a key before the `=`",
    ..Rule::NEW
};

/// The finding about a line without a key.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    let finding = RULE.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}
