use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::lines;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "W0104",
    severity: Warning,
    title: "text after a section header",
    why: "Most EDS parsers stop at such a line. odkit ignores the text.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` follows the section header `[{name}]`",
    help: "move the text to a line that starts with `;`{fix}",
    ..Rule::NEW
};

/// The finding about text behind a header, which becomes a comment below it.
pub(crate) fn finding(name: &str, text: Spanned<&str>) -> Finding {
    let comment = lines::comment(text.trim_start_matches([';', '#']));
    let comment = format!("\n{comment}");
    let finding = RULE.given(&text).fact("name", name);
    finding.fix(Fix::safe().replace(text.span, comment))
}
