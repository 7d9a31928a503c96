use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0404",
    severity: Error,
    buildable: true,
    title: "AccessType is missing",
    why: "Every value has an AccessType. odkit assumes `ro`.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{AccessType} is missing",
    help: "add `{AccessType=ro}`{fix}, or another access type",
    ..Rule::NEW
};

/// The finding about a section without AccessType.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
        .fix(Fix::unsafe_fix().below(header, "AccessType=ro"))
}
