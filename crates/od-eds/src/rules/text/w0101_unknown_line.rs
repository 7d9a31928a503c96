use crate::finding::{Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "W0101",
    severity: Warning,
    title: "line is not a section, a key or a comment",
    why: "Most EDS parsers stop at such a line. odkit ignores it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{given}` is not a section, a `key=value` line or a comment",
    help: "start the line with `;`{fix}, or remove it",
    also: &[NO_SIGN],
    ..Rule::NEW
};

/// Sentence for a key and a value without an equals sign.
const NO_SIGN: Form = Form {
    says: "`=` is missing; odkit reads `{name}={given}`",
    help: "write `{name}={given}`{fix}",
};

/// The finding about a key and a value with only `at` between them.
pub(crate) fn no_sign(at: Span, key: &str, value: &str) -> Finding {
    let finding = RULE.at(at).form(&NO_SIGN).fact("name", key);
    finding
        .fact("given", value)
        .fix(Fix::safe().replace(at, "="))
}

/// The finding about a line that is nothing known.
pub(crate) fn finding(line: Spanned<&str>) -> Finding {
    let finding = RULE.given(&line);
    finding.fix(Fix::safe().comment_out(line.span))
}
