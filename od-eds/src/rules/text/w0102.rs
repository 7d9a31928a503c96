use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0102",
    severity: Warning,
    title: "line has no key before the `=`",
    why: "Nothing can ask for a value without a key. The line is ignored.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` has no key before the `=`",
    help: "the line is ignored; remove it, or name the key",
    ..Rule::NEW
};

/// The finding about a line without a key.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    let finding = RULE.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}
