use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "W0103",
    severity: Error,
    buildable: true,
    title: "section header has no closing bracket",
    why: "Most EDS parsers stop at such a line. odkit assumes that the header ends with its line.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "header of section `{given}` has no closing bracket",
    help: "write `[{given}]`{fix}",
    ..Rule::NEW
};

/// The finding about a header that its line ends.
pub(crate) fn finding(line: Span, name: Spanned<&str>) -> Finding {
    let fix = Fix::safe().replace(name.span, format!("{}]", *name));
    RULE.at(line).fact("given", *name).fix(fix)
}
