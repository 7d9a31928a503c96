use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0320",
    severity: Info,
    title: "value is empty",
    why: "Many tools stop at a number, a type or an access without a value. odkit treats the line as missing.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "`{name}` is empty",
    help: "remove the line{fix}, or write a value for `{name}`",
    ..Rule::NEW
};

/// The finding about a key without the value that it needs. There is no fix if the key follows once more, which odkit
/// would read then, or if tools stop at an object without the key: AccessType and DataType need a value.
pub(crate) fn finding(key: &Text<'_>, is_single: bool) -> Finding {
    let finding = RULE.at(key.span).fact("name", &*key.value);
    let is_needed = ["AccessType", "DataType"]
        .iter()
        .any(|needed| key.eq_ignore_ascii_case(needed));
    if is_single && !is_needed {
        finding.fix(Fix::safe().remove_line(key.span))
    } else {
        finding
    }
}
