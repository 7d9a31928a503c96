use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0101",
    severity: Warning,
    title: "line is no section, no key and no comment",
    why: "Most readers stop at such a line. It is ignored here.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` is no section, no `key=value` and no comment",
    help: "the line is ignored; begin it with `;` to make it a comment",
    ..Rule::NEW
};

/// The finding about a line that is nothing known.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    let finding = RULE.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}
