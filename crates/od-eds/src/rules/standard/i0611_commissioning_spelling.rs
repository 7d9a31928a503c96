use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "I0611",
    severity: Info,
    title: "DeviceCommissioning is spelled with two m",
    why: "Many tools know only the spelling of the standard, `DeviceComissioning`. odkit reads both.",
    source: "CiA 306-1, DCF",
    fixability: Fixability::Either,
    says: "CiA 306 spells `DeviceCommissioning` with one m",
    help: "write `[DeviceComissioning]`{fix}",
    ..Rule::NEW
};

/// The finding about the header. A tool that ignores the section now may stop at a value that is not valid.
pub(crate) fn finding(header: Span, is_valid: bool) -> Finding {
    let fix = if is_valid {
        Fix::safe()
    } else {
        Fix::unsafe_fix()
    };
    RULE.at(header)
        .fix(fix.replace(header, "[DeviceComissioning]"))
}
