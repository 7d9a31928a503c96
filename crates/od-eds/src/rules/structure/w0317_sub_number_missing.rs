use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0317",
    severity: Warning,
    title: "SubNumber is missing",
    why: "A tool cannot tell how many sub-objects to read. odkit counts the sections.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "{SubNumber} is missing",
    help: "write `{SubNumber={count}}`{fix}",
    ..Rule::NEW
};

/// The finding about an object with sub-objects and no SubNumber.
pub(crate) fn finding(header: Span, count: u32) -> Finding {
    let fix = Fix::safe().below(header, format!("SubNumber={count}"));
    RULE.at(header).fact("count", count).fix(fix)
}
