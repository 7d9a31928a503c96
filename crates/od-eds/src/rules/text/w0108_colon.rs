use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0108",
    severity: Warning,
    title: "`:` instead of `=`",
    why: "Only some EDS parsers accept it. odkit reads it as `=`.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Safe,
    says: "`{name}` is followed by `:` instead of `=`",
    help: "write `{name}={given}`{fix}",
    ..Rule::NEW
};

/// The finding about a colon between key and value.
pub(crate) fn finding(colon: Span, key: &str, value: &str) -> Finding {
    let finding = RULE.at(colon).fact("name", key).fact("given", value);
    finding.fix(Fix::safe().replace(colon, "="))
}
