use crate::finding::{Finding, Rule, Severity::Error};
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "E0118",
    severity: Error,
    title: "mark of a merge conflict",
    why: "The file has two versions of the lines around the mark, and most tools stop at it. odkit ignores the mark and reads both versions.",
    source: "CiA 306-1, file format; git, merge conflicts",
    says: "`{given}` is a mark of a merge conflict that is not resolved",
    help: "keep one of the two versions, and remove the lines with `<<<<<<<`, `=======` and `>>>>>>>`",
    ..Rule::NEW
};

/// The finding about a line that git writes between two versions.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    RULE.given(&line)
}
