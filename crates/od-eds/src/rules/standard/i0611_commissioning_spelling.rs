use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0611",
    severity: Info,
    title: "DeviceCommissioning is spelled with two m",
    why: "Many tools know only the spelling of the standard, `DeviceComissioning`. odkit reads both.",
    source: "CiA 306-1, DCF",
    fixability: Fixability::Safe,
    says: "CiA 306 spells `DeviceCommissioning` with one m",
    help: "write `[DeviceComissioning]`{fix}",
    ..Rule::NEW
};

/// The finding about the header.
pub(crate) fn finding(header: Span) -> Finding {
    let fix = Fix::safe().replace(header, "[DeviceComissioning]");
    RULE.at(header).fix(fix)
}
