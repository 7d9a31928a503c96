use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0611",
    severity: Info,
    title: "DeviceCommissioning with two m",
    why: "The standard writes `DeviceComissioning`. Both are read; many readers know only one.",
    source: "CiA 306-1, DCF",
    fixability: Fixability::Safe,
    says: "`DeviceCommissioning` is not how CiA 306 spells it",
    help: "write `[DeviceComissioning]`, with one m, as the standard does",
    ..Rule::NEW
};

/// The finding about the header.
pub(crate) fn finding(header: Span) -> Finding {
    let fix = Fix::safe().replace(header, "[DeviceComissioning]");
    RULE.at(header).fix(fix)
}
